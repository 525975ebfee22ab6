"""The knife: slits along lines, as wide as is said, closed where they are painted."""

import itertools
import tracemalloc

import numpy as np
import pictures
import pytest
import shapely
from messages import says
from numpy.testing import assert_allclose

from engine.arrays import Booleans, Complexes
from engine.domain import MeshedDomain, build_domain, find_closed_cuts, require_domain
from engine.domain.meshing.mesh import signed_areas
from engine.domain.outline.cuts import CUTS_OFF, _drawn_area
from engine.domain.outline.enclosure import Enclosure, enclose_subject
from engine.domain.outline.slit_sides import CUT_WIDTH
from engine.errors import EngineError
from engine.geometry import as_xy, shapely_region

SIZE = 400
DIAGONAL = 360 * np.sqrt(2)


def block() -> Booleans:
    """A square of 360 pixels, from 20 to 380."""
    mask = np.zeros((SIZE, SIZE), dtype=np.bool_)
    mask[20:-20, 20:-20] = True
    return mask


def cut(*lines: list[complex], mask: Booleans | None = None) -> Enclosure:
    mask = block() if mask is None else mask
    return enclose_subject(mask, detail="normal", slits=[np.array(line) for line in lines])


def opening(enclosure: Enclosure, start: complex, end: complex) -> float:
    """How much of the way from one point to another lies in no region."""
    way = shapely.LineString(as_xy(np.array([start, end])))
    inside = shapely_region(enclosure.outline, [hole.outline for hole in enclosure.holes])
    return way.length - float(shapely.intersection(way, inside).length)


@pytest.mark.parametrize(
    ("line", "across"),
    [
        ([200 - 5j, 200 + 250j], [(150 + y * 1j, 250 + y * 1j) for y in (40, 120, 245)]),
        (
            [0 + 100j, 150 + 160j, 300 + 150j],
            [(100 + 90j, 100 + 200j), (220 + 100j, 220 + 200j)],
        ),
    ],
)
def test_a_slit_is_as_wide_as_is_said_along_all_of_its_line(line, across) -> None:
    parted = cut(line)
    middle = shapely.LineString(as_xy(np.array(line)))
    for start, end in across:
        way = shapely.LineString(as_xy(np.array([start, end])))
        crossed = shapely.intersection(way, middle)
        pieces = shapely.get_coordinates(middle)
        nearest = min(
            itertools.pairwise(pieces),
            key=lambda piece: shapely.distance(shapely.LineString(piece), crossed),
        )
        along = np.diff(np.array(nearest) @ [1, 1j])[0]
        sine = abs(np.sin(np.angle((end - start) / along)))
        assert_allclose(opening(parted, start, end) * sine, CUT_WIDTH * DIAGONAL, rtol=1e-3, atol=0)
    assert not parted.holes  # the line ends inside: the region stays simply connected
    assert shapely_region(parted.outline).is_valid


def test_the_sides_meet_where_they_are_painted() -> None:
    parted = cut([200 - 5j, 200 + 250j])
    assert parted.closed is not None
    moved = parted.closed - parted.outline
    beside = np.abs(parted.outline.real - 200) < CUT_WIDTH * DIAGONAL
    beside &= parted.outline.imag < 250 - 1e-6
    assert beside.sum() > 10
    assert_allclose(moved[~beside], 0, rtol=0, atol=0)
    # Both reach a little beyond the middle line.
    side = np.sign(parted.outline.real[beside] - 200)
    past = -side * (parted.closed.real[beside] - 200)
    assert (past > 0).all()
    assert past.max() < 0.1 * CUT_WIDTH * DIAGONAL
    assert_allclose(moved.imag, 0, rtol=0, atol=1e-6)


def parted_domain(mask: Booleans, *lines: list[complex], triangles: int = 4000) -> MeshedDomain:
    domain, _ = build_domain(mask, triangles=triangles, detail="normal", cut_lines=lines)
    require_domain(domain)
    return domain


@pytest.mark.parametrize("triangles", [1000, 40_000])
def test_a_seam_closes_the_mesh_without_a_fold_and_is_the_same_in_every_affine_pose(
    triangles: int,
) -> None:
    domain = parted_domain(
        block(), [200 - 5j, 210 + 250j], [0 + 100j, 150 + 120j], triangles=triangles
    )
    seam = find_closed_cuts(domain)
    assert seam is not None
    assert domain.closed is not None
    corners = len(np.concatenate(domain.loops))
    rest: Complexes = seam.close_cuts(domain.mesh.vertices)
    assert_allclose(rest[:corners], domain.closed, rtol=0, atol=1e-9 * DIAGONAL)
    areas = signed_areas(rest, domain.mesh.triangles)
    assert (areas > 0).all()
    # What was cut out is covered: by both sides where they overlap.
    assert areas.sum() >= shapely.Polygon(as_xy(domain.outline)).area + 0.9 * (
        CUT_WIDTH * DIAGONAL * (230 + 120)
    )

    def affine(z: Complexes) -> Complexes:
        return (1.3 - 0.4j) * z + 0.2j * z.conj() + 7

    assert_allclose(
        seam.close_cuts(affine(domain.mesh.vertices)), affine(rest), rtol=0, atol=1e-6 * DIAGONAL
    )


def test_a_domain_without_a_slit_has_no_seam() -> None:
    assert find_closed_cuts(parted_domain(block())) is None


def test_lines_that_cross_part_one_region_in_four() -> None:
    parted = cut([200 - 5j, 200 + 300j], [100 + 150j, 300 + 150j])
    assert not parted.holes
    inside = shapely_region(parted.outline)
    assert inside.is_valid
    # The second line reaches no edge: it is one slit with the first.
    for start, end in (
        (150 + 140j, 150 + 160j),
        (250 + 140j, 250 + 160j),
        (190 + 250j, 210 + 250j),
    ):
        assert_allclose(opening(parted, start, end), CUT_WIDTH * DIAGONAL, rtol=1e-3, atol=0)
    assert parted.closed is not None
    corner = np.abs(parted.outline - (200 + 150j)) < CUT_WIDTH * DIAGONAL
    assert corner.sum() == 4
    assert np.abs(parted.closed[corner] - (200 + 150j)).max() < 0.1 * CUT_WIDTH * DIAGONAL


def test_a_line_opens_a_ring_and_may_join_two_holes() -> None:
    ring = pictures.ring(SIZE)[..., 3] > 0
    assert len(cut(mask=ring).holes) == 1
    opened = cut([200 - 5j, 200 + 200j], mask=ring)
    assert not opened.holes
    mask = block()
    mask[160:240, 80:160] = mask[160:240, 240:320] = False
    joined = cut([120 + 200j, 280 + 200j], mask=mask)
    assert len(joined.holes) == 1
    assert joined.closed is not None
    assert len(joined.closed) == len(joined.outline) + len(joined.holes[0].outline)
    domain = parted_domain(mask, [120 + 200j, 280 + 200j])
    assert find_closed_cuts(domain) is not None


def test_a_line_that_begins_at_the_edge_that_is_seen_is_led_out() -> None:
    """The outline keeps a margin from the drawing's pixels."""
    parted = cut([200 + 21j, 200 + 200j])
    assert opening(parted, 150 + 15j, 250 + 15j) > 0


def test_a_trembling_line_has_few_vertices() -> None:
    rng = np.random.default_rng(0)
    line = 200 + 1j * np.linspace(-5, 250, 300) + rng.normal(0, 0.12, 300)
    assert len(cut(list(line)).outline) < len(cut().outline) + 40


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ([[500 + 0j, 500 + 300j]], "does not touch the drawing"),
        ([[200 - 5j, 200 + 405j]], r"cuts off \d+\.\d% of the drawing"),
        ([[150 - 5j, 150 + 200j, 250 + 200j, 250 - 5j]], says(CUTS_OFF)),
        ([[200 - 5j, 200 + 200j, 300 + 200j, 300 + 100j, 100 + 100j]], says(CUTS_OFF)),
        ([[100 - 5j, 100 + 200j], [0 + 150j, 200 + 150j]], says(CUTS_OFF)),
        ([[200 - 5j, 200 + 250j], [201.8 - 5j, 201.8 + 250j]], "runs along an edge"),
        ([[200 + 200j, 200.5 + 200j]], "too short"),
    ],
)
def test_lines_that_part_nothing_or_too_much_are_refused(lines, message: str) -> None:
    with pytest.raises(EngineError, match=message):
        cut(*lines)


@pytest.mark.parametrize("beside", [[-5 + 18.5j, 405 + 18.5j], [0 + 18j, 350 + 18j]])
def test_a_line_beside_the_drawing_may_cut_off_some_of_the_margin(beside) -> None:
    parted = cut(beside, [200 - 5j, 200 + 250j])
    assert opening(parted, 150 + 100j, 250 + 100j) > 0


def test_slivers_that_are_long_take_neither_memory_nor_sense() -> None:
    sliver = shapely.Polygon([(20, 20), (380, 380), (380 + 1e-7, 380), (20 + 1e-7, 20)])
    tracemalloc.start()
    area = _drawn_area(sliver, block())
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert area < 1
    assert peak < 1e8
