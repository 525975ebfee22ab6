import numpy as np
import pytest
from holed_shapes import ring
from interpolation_shapes import around, bar, letter_l, narrow_u, spiral
from numpy.testing import assert_allclose, assert_array_equal

from engine.dirichlet.boundary_operator import BoundaryOperator
from engine.dirichlet.hilbert import HilbertTransform
from engine.dirichlet.panels import Panels
from engine.dirichlet.partition import partition_panels
from engine.dirichlet.skeleton_solver import SkeletonSolver
from engine.geometry import Domain


def operator_on(shape, coarseness=4.0):
    loops = (shape.outline, shape.cage, shape.holes) if hasattr(shape, "holes") else shape
    return BoundaryOperator.of(Panels.on(Domain(*loops), coarseness=coarseness))


@pytest.mark.parametrize("shape", [bar(), letter_l(), narrow_u(), spiral(1.2), ring(sides=24)])
def test_the_fast_solver_solves_the_whole_matrix(shape):
    operator = operator_on(shape)
    everything, roots = np.arange(len(operator.nodes)), operator.roots[:, None]
    matrix = operator.entries(everything, everything)[0] * roots.T / roots
    rng = np.random.default_rng(0)
    smooth = np.column_stack([np.sin(operator.nodes.real), operator.nodes.imag**2])
    right = np.column_stack([smooth, rng.normal(size=len(everything))])
    expected = np.linalg.solve(matrix, right)
    found = SkeletonSolver.of(operator)(right)
    assert_allclose(found, expected, rtol=0, atol=1e-7 * np.abs(expected).max())


@pytest.mark.parametrize("shape", [letter_l(), ring(sides=24)])
def test_a_part_of_the_matrix_is_what_it_is_in_the_whole(shape):
    operator = operator_on(shape)
    everything = np.arange(len(operator.nodes))
    whole, transposed = operator.entries(everything, everything)
    assert_allclose(transposed, whole.T, rtol=1e-13, atol=1e-14)
    rng = np.random.default_rng(1)
    rows, columns = rng.permutation(everything)[:50], rng.permutation(everything)[:70]
    forward, backward = operator.entries(rows, columns)
    assert_array_equal(forward, whole[np.ix_(rows, columns)])
    assert_array_equal(backward, transposed[np.ix_(rows, columns)])


def test_rows_of_the_matrix_sum_to_one():
    # ∮ Im dζ / (ζ − z) of a constant is half a turn at a node.
    operator = operator_on(letter_l())
    everything = np.arange(len(operator.nodes))
    sums = operator.entries(everything, everything)[0] @ operator.roots
    assert_allclose(sums, operator.roots, rtol=1e-9, atol=0)


def panels_on_a_line():
    lines = np.arange(40.0)
    return Panels(
        origin=lines + 0j,
        span=np.ones(40) + 0j,
        power=np.ones(40, dtype=np.intp),
        forward=np.ones(40, dtype=np.bool_),
        starts=np.zeros(1, dtype=np.intp),
    )


@pytest.mark.parametrize("depth", [0, 1, 4])
@pytest.mark.parametrize("panels", [Panels.on(Domain(*narrow_u())), panels_on_a_line()])
def test_boxes_share_all_panels_out(panels, depth):
    boxes = partition_panels(panels, depth)
    assert len(boxes) == 2**depth
    assert min(len(box) for box in boxes) > 0
    assert_array_equal(np.sort(np.concatenate(boxes)), np.arange(len(panels)))


def test_a_factorisation_tells_how_far_it_is_and_can_be_ended():
    shares = []
    HilbertTransform.on(Domain(*narrow_u()), progress=shares.append)
    assert shares[0] == 0
    assert shares[-1] == 1
    assert (np.diff(shares) > 0).all()
    # Each is soon over: there are as many as boxes.
    assert len(shares) > 60

    def cancel(share):
        if share > 0.1:
            raise TimeoutError

    with pytest.raises(TimeoutError):
        HilbertTransform.on(Domain(*narrow_u()), progress=cancel)


def wound(turns):
    """Return a band of unit pitch, half as wide, that winds around itself so many times."""
    angle = 2 * np.pi * np.linspace(1, 1 + turns, 14 * turns)
    turn = np.exp(1j * angle)
    sides = [(angle / (2 * np.pi) + offset) * turn for offset in (0.25, -0.25)]
    outline = np.concatenate([sides[0], sides[1][::-1]])
    return outline, around(outline, 0.06)


def size_of(shape, coarseness):
    """Return the nodes of a solver, its bytes, and the largest rank."""
    solver = SkeletonSolver.of(operator_on(shape, coarseness))
    return len(solver.roots), solver.nbytes, max(len(box.kept) for box in solver.boxes)


def test_sides_that_face_each_other_closely_take_little_more_a_node():
    # Boxes along the outline took 16 times as much a node, and ranks of 3,000.
    (nodes, wide, _), (more, narrow, rank) = (size_of(narrow_u(gap), 2.0) for gap in (1e-2, 1e-3))
    assert narrow / more < 1.5 * wide / nodes
    assert rank < 200


@pytest.mark.parametrize(
    ("turns", "coarseness"), [(1, 2.0), pytest.param(2, 1.0, marks=pytest.mark.long)]
)
def test_windings_take_little_more_a_node(turns, coarseness):
    # Boxes along the outline took 5.4 times as much for four turns, with ranks of 1,421.
    (nodes, few, _), (more, many, rank) = (
        size_of(wound(count), coarseness) for count in (turns, 2 * turns)
    )
    assert 1.8 * nodes < more
    assert many < 4 * few
    assert rank < 500
