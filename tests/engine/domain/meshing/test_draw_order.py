from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from overlaps import overlaps
from shapes import regular_polygon

from engine.domain.meshing.draw_order import copy_draw_order, order_branches_on_top
from engine.domain.meshing.mesh import Mesh
from engine.domain.meshing.triangulation import triangulate
from engine.geometry.polygon import deepest_point, signed_area

# A U, which a walk from its left tip to its right tip has to follow all the way round.
U = np.array([0, 3, 3 + 4j, 2 + 4j, 2 + 1j, 1 + 1j, 1 + 4j, 4j])
ARMS = 5
BODY, ROOT = -1, -2
HALF_WIDTH = 0.35
BASE = 1.2  # where the arms of a star begin to bend
RNG = np.random.default_rng(7)
BENDS = RNG.uniform(-2, 2, (12, ARMS))  # radians for each unit of length
# A wheel of radius 1, and a slot between its upper half and the tyre there.
INSIDE, TYRE = 0.84, 0.9
SLOT = np.radians([20, 160])


def star(lengths):
    """A star with arms of these lengths and a body of radius 1."""
    points = []
    for arm, length in enumerate(lengths):
        turn = np.exp(2j * np.pi * arm / len(lengths))
        inner = 0.6 / np.cos(np.pi / len(lengths)) * np.exp(-1j * np.pi / len(lengths))
        points += [
            turn * inner,
            turn * (length - 1j * HALF_WIDTH),
            turn * (length + 1j * HALF_WIDTH),
        ]
    return np.array(points)


def arms_of(points):
    """Tell in which arm of a star points are: BODY where in none, ROOT where that is open."""
    arms = np.round(np.angle(points) / (2 * np.pi / ARMS)).astype(int) % ARMS
    along = (points * np.exp(-2j * np.pi * arms / ARMS)).real
    return np.select([along > BASE, along < 0.5], [arms, BODY], ROOT)


def bent(points, bends):
    """Bend each arm of a star to an arc, by so many radians for each unit of its length."""
    result = points.copy()
    for arm, bend in enumerate(bends):
        inside = arms_of(points) == arm
        turn = np.exp(2j * np.pi * arm / ARMS)
        place = points[inside] / turn - BASE
        onward = np.exp(1j * bend * place.real)
        result[inside] = turn * (BASE + (onward - 1) / (1j * bend) + 1j * place.imag * onward)
    return result


def test_triangles_come_in_the_order_of_their_way_from_the_centre():
    mesh = triangulate(U, 2000)
    ordered = order_branches_on_top(mesh, 0.5 + 4j)
    assert_array_equal(ordered.vertices, mesh.vertices)
    assert_array_equal(np.unique(ordered.triangles, axis=0), np.unique(mesh.triangles, axis=0))
    middles = ordered.vertices[ordered.triangles].mean(axis=1)
    left = (middles.real < 1) & (middles.imag > 1.2)
    right = (middles.real > 2) & (middles.imag > 1.2)
    # Along the left limb downwards, then along the right one upwards, in spite of the short gap.
    assert np.flatnonzero(left).max() < np.flatnonzero(right).min()
    assert np.corrcoef(np.flatnonzero(left), -middles[left].imag)[0, 1] > 0.95
    assert np.corrcoef(np.flatnonzero(right), middles[right].imag)[0, 1] > 0.95


@pytest.mark.parametrize("bends", BENDS)
def test_of_two_limbs_one_covers_the_other_wherever_they_cross(bends):
    outline = star([4.0, 4.5, 5.5, 4.1, 5.0])
    mesh = order_branches_on_top(triangulate(outline, 3000), 0j)
    arms = arms_of(mesh.vertices[mesh.triangles].mean(axis=1))
    pairs, overlap = overlaps(bent(mesh.vertices, bends), mesh.triangles)
    assert len(pairs) > 0
    above, below = arms[pairs].T
    for one in range(ARMS):
        for other in range(-1, one):
            crossing = (above == one) & (below == other)
            higher = pairs[crossing, 0] > pairs[crossing, 1]
            assert higher.all() or (other >= 0 and not higher.any())
    # An arm that has turned round lies over itself, one sheet over the other.
    own = (above == below) & (above >= 0)
    over = np.bincount(overlap[own], pairs[own, 0] > pairs[own, 1])
    assert_array_equal(over * (np.bincount(overlap[own]) - over), 0)


def test_the_order_of_limbs_is_the_same_in_each_pose_and_from_fine_to_coarse():
    outline = star([3.0] * ARMS)
    fine = order_branches_on_top(triangulate(outline, 8000), 0j)
    coarse = copy_draw_order(triangulate(outline, 1500), fine)
    orders = []
    for mesh in (fine, coarse):
        arms = arms_of(mesh.vertices[mesh.triangles].mean(axis=1))
        places = [np.flatnonzero(arms == arm) for arm in range(-1, ARMS)]
        order = np.argsort([place.mean() for place in places])
        orders.append(order)
        for lower, upper in pairwise(order):
            assert places[lower].max() < places[upper].min()
    assert orders[0][0] == 0  # the body
    assert_array_equal(*orders)


def test_a_tyre_covers_the_wheel_that_it_is_pulled_over():
    arc = np.exp(1j * np.linspace(*SLOT, 60))
    slot = np.concatenate([INSIDE * arc, TYRE * arc[::-1]])
    mesh = order_branches_on_top(triangulate(regular_polygon(180), 6000, holes=[slot]), 0.6j)

    def on_tyre(points, turns):
        return (np.abs(points) > TYRE - 1e-3) & (np.abs(np.angle(points / 1j)) < turns)

    half = np.ptp(SLOT) / 2
    pull = 1.2 * np.sqrt(np.cos(np.clip(np.angle(mesh.vertices / 1j) / half, -1, 1) * np.pi / 2))
    pulled = np.where(on_tyre(mesh.vertices, half), mesh.vertices - 1j * pull, mesh.vertices)
    pairs, _ = overlaps(pulled, mesh.triangles)
    middles = mesh.vertices[mesh.triangles].mean(axis=1)
    inside = np.abs(middles) < INSIDE
    crossing = pairs[on_tyre(middles, 0.9 * half)[pairs[:, 0]] & inside[pairs[:, 1]]]
    assert len(crossing) > 1000
    assert (crossing[:, 0] > crossing[:, 1]).all()


def test_the_ways_around_a_hole_are_two_limbs():
    outline, hole = regular_polygon(40), 0.6 * regular_polygon(30)[::-1]
    ordered = order_branches_on_top(triangulate(outline, 2000, holes=[hole]), 0.8)
    turns = np.angle(ordered.vertices[ordered.triangles].mean(axis=1))
    # Less where they begin and where they meet.
    sides = [
        np.flatnonzero((turns > 0.5) & (turns < 2.7)),
        np.flatnonzero((turns < -0.5) & (turns > -2.7)),
    ]
    first, second = sorted(sides, key=np.min)
    assert first.max() < second.min()
    for side in sides:
        assert np.corrcoef(side, np.abs(turns[side]))[0, 1] > 0.98


def test_what_is_plump_is_no_limb():
    square = np.array([0, 1, 1 + 1j, 1j])
    mesh = order_branches_on_top(triangulate(square, 2000), 0.5 + 0.5j)
    ways = np.abs(mesh.vertices[mesh.triangles].mean(axis=1) - (0.5 + 0.5j))
    assert np.corrcoef(np.arange(len(ways)), ways)[0, 1] > 0.95


def test_triangles_stay_counter_clockwise():
    square = np.array([0, 1, 1 + 1j, 1j])
    mesh = Mesh(vertices=square, triangles=np.array([[2, 3, 0], [0, 1, 2]], dtype=np.int32))
    assert_array_equal(np.sort(order_branches_on_top(mesh, 0).areas()), np.sort(mesh.areas()))


def test_the_deepest_point_of_a_rectangle_is_on_its_middle_line():
    rectangle = np.array([0, 10, 10 + 4j, 4j])
    point = deepest_point(rectangle)
    assert abs(point.imag - 2) < 2e-3
    assert signed_area(rectangle) == 40
