"""Edges that meet, and discs between limbs, where the answer is known."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from shapes import regular_polygon, star_polygons

from engine.arrays import Complexes
from engine.domain.outline.crossings import find_crossing_edges, find_meeting_edges
from engine.domain.outline.gaps import empty_disc_radius
from engine.geometry import distance_to_boundary


@given(polygon=star_polygons())
def test_a_simple_polygon_crosses_nothing(polygon: Complexes) -> None:
    assert not find_crossing_edges(polygon).any()
    assert not any(edges.any() for edges in find_meeting_edges(polygon, 2 * polygon))


def test_crossing_reports_both_edges_and_no_other() -> None:
    bow = np.array([0, 2 + 2j, 2, 2j, -1 + 1j])  # 0 to 1 crosses 2 to 3
    assert_array_equal(find_crossing_edges(bow), [True, False, True, False, False])


def test_a_vertex_on_an_edge_meets_it() -> None:
    touching = np.array([0, 4, 4 + 4j, 2 + 0j, 4j])
    assert find_crossing_edges(touching)[[0, 2, 3]].all()


def test_edges_of_two_polygons_meet() -> None:
    square = np.array([0, 2, 2 + 2j, 2j])
    own, other = find_meeting_edges(square, square + 1)
    assert_array_equal(own, [True, True, True, False])
    assert_array_equal(other, [True, False, True, True])
    own, other = find_meeting_edges(square, 0.5 * square + 1)  # one corner of it stands out
    assert own.tolist() == [True, True, False, False]


@given(angle=st.floats(-0.7, 0.7), radius=st.floats(0.1, 10))
def test_the_empty_disc_touches_both_places(angle: float, radius: float) -> None:
    # q on the circle of that radius that touches the curve at 0, with the normal 1.
    across = np.array([radius * (1 + np.exp(2j * angle))])
    assert_allclose(empty_disc_radius(np.array([1 + 0j]), across), radius, rtol=1e-9, atol=0)


@pytest.mark.parametrize("across", [-1 + 0j, 1j, 0.1 + 1j])
def test_what_does_not_lie_opposite_makes_no_gap(across: complex) -> None:
    assert empty_disc_radius(np.array([1 + 0j]), np.array([across])) == np.inf


def test_the_disc_between_two_walls_fills_half_their_gap() -> None:
    wall = 3 + 1j * np.linspace(-5, 5, 1001)
    assert_allclose(empty_disc_radius(np.ones(1), wall).min(), 1.5, rtol=1e-4, atol=0)
    # And what lies opposite in a ring leaves room for a disc of its size.
    ring = 2 * regular_polygon(100)
    inside = ring[30:71] - ring[0]
    assert_allclose(empty_disc_radius(-np.ones(1), inside).min(), 2, rtol=1e-6, atol=0)
    assert distance_to_boundary(ring, np.zeros(1)) > 1.99
