import numpy as np
import pytest
from hypothesis import given
from messages import says
from numpy.testing import assert_allclose
from shapes import regular_polygon, star_polygons

from engine.arrays import Complexes
from engine.errors import EngineError
from engine.geometry import (
    constrained_delaunay,
    contains,
    deepest_point,
    diameter,
    distance_to_boundary,
    distance_to_segments,
    require_around,
    require_inside,
    sample_graded,
    signed_area,
    winding_number,
)
from engine.geometry.polygon import CAGE_ORDER, OUTSIDE_OUTLINE


@given(outline=star_polygons())
def test_graded_samples_are_as_dense_as_asked_and_no_denser_than_bisection_makes_them(
    outline: Complexes,
) -> None:
    centres = 1.2 * outline
    distance = distance_to_boundary(outline, centres).min()
    samples = sample_graded(outline, centres, ratio=0.5, longest=0.25)
    ends = np.roll(samples, -1)
    allowed = np.minimum(0.5 * distance_to_segments(centres, samples, ends).min(axis=0), 0.25)
    lengths = np.abs(ends - samples)
    assert (lengths <= allowed * (1 + 1e-12)).all()
    # A piece is half of one that was too long, hence longer than half of what the nearest allows.
    whole = np.abs(np.roll(outline, -1) - outline).min()
    assert lengths.min() > 0.5 * min(0.5 * distance, 0.25, whole) * (1 - 1e-9)


@given(outline=star_polygons())
def test_graded_samples_follow_the_polygon_through_its_vertices(outline: Complexes) -> None:
    samples = sample_graded(outline, 1.3 * outline, ratio=0.6, longest=0.2)
    places = [int(np.flatnonzero(samples == vertex)[0]) for vertex in outline]
    assert places[0] == 0
    assert places == sorted(places)
    # No way back, no detour: the closed polyline is as long as the polygon.
    assert_allclose(
        np.abs(np.roll(samples, -1) - samples).sum(),
        np.abs(np.roll(outline, -1) - outline).sum(),
        rtol=1e-12,
        atol=0,
    )


def test_samples_crowd_where_a_centre_is_near() -> None:
    square = np.array([0, 1, 1 + 1j, 1j])
    samples = sample_graded(square, np.array([0.5 - 0.001j]), ratio=0.5, longest=0.5)
    gaps = np.abs(np.roll(samples, -1) - samples)
    nearest = int(np.abs(samples - 0.5).argmin())
    assert gaps[nearest] <= 0.0005
    assert gaps.max() == 0.5


def test_a_centre_on_the_polygon_is_refused() -> None:
    with pytest.raises(EngineError, match="lies on the outline"):
        sample_graded(regular_polygon(6), np.array([1.0 + 0j]), ratio=0.5, longest=1.0)


@given(outline=star_polygons())
def test_constrained_delaunay_triangles_are_the_polygon(outline: Complexes) -> None:
    triangles = constrained_delaunay(outline)
    assert triangles.shape == (len(outline) - 2, 3)
    a, b, c = outline[triangles].T
    areas = ((b - a).conj() * (c - a)).imag / 2
    assert areas.min() >= -1e-15
    assert_allclose(areas.sum(), signed_area(outline), rtol=1e-12, atol=0)
    # Every side of the polygon is a side of one triangle, in the same direction.
    sides = {(i, j) for k in range(3) for i, j in triangles[:, [k, (k + 1) % 3]].tolist()}
    assert {(i, (i + 1) % len(outline)) for i in range(len(outline))} <= sides


def test_windings_are_counted_with_their_sign() -> None:
    circle = regular_polygon(9)
    assert winding_number(circle, 0.3j) == 1
    assert winding_number(circle[::-1], 0.3j) == -1
    assert winding_number(circle, 1.1) == 0
    assert winding_number(np.concatenate([circle, circle]), 0.0) == 2


def test_a_cage_must_go_around_the_outline_once() -> None:
    outline = regular_polygon(7)
    require_around(1.2 * outline, outline)
    for cage in (0.9 * outline, outline + 0.3, outline):
        with pytest.raises(EngineError, match=r"touches or crosses|run once"):
            require_around(cage, outline)
    for cage in (1.2 * outline[::-1], 1.2 * outline + 5):
        with pytest.raises(EngineError, match=says(CAGE_ORDER)):
            require_around(cage, outline)


def test_the_first_point_outside_is_named() -> None:
    outline = regular_polygon(40)
    points = np.array([0, 1.5, 0.5j, 2 - 2j])
    with pytest.raises(EngineError, match=r"point 1 at \(1\.5, 0\) .* \(2 of 4 are\)"):
        require_inside(outline, points, "point")
    with pytest.raises(
        EngineError,
        match=says(OUTSIDE_OUTLINE, name="anchor", number="", x=2, y=-2, holes=""),
    ):
        require_inside(outline, points[3:], "anchor")
    require_inside(outline, points, "point", tolerance=2.0)


RING = regular_polygon(80)
HOLES = (0.5 * RING[::-1],)


def test_a_hole_is_outside_and_its_edge_is_boundary() -> None:
    points = np.array([0, 0.45, 0.5, 0.75, 1.2])
    assert contains(RING, points, holes=HOLES).tolist() == [False, False, True, True, False]
    assert contains(RING, points, holes=HOLES, tolerance=0.06).tolist()[:2] == [False, True]
    assert_allclose(
        distance_to_boundary(RING, points, HOLES), [0.4996, 0.05, 0, 0.25, 0.2], rtol=0, atol=1e-3
    )
    with pytest.raises(
        EngineError, match=says(OUTSIDE_OUTLINE, name="point", number=" 0", x=0, y=0)
    ):
        require_inside(RING, points[:4], "point", holes=HOLES)


def test_the_deepest_point_of_a_ring_is_between_its_edges() -> None:
    assert_allclose(abs(deepest_point(RING, HOLES)), 0.75, rtol=0, atol=2e-3)


def test_constrained_delaunay_leaves_holes_out() -> None:
    triangles = constrained_delaunay(RING, HOLES)
    assert triangles.shape == (160, 3)
    a, b, c = np.concatenate([RING, *HOLES])[triangles].T
    areas = ((b - a).conj() * (c - a)).imag / 2
    assert areas.min() > 0
    assert_allclose(areas.sum(), signed_area(RING) + signed_area(HOLES[0]), rtol=1e-12, atol=0)


@given(polygon=star_polygons())
def test_diameter_is_the_largest_distance_of_vertices(polygon: Complexes) -> None:
    largest = np.abs(polygon[:, None] - polygon).max()
    assert_allclose(diameter(polygon), largest, rtol=1e-14, atol=0)


@pytest.mark.parametrize("count", [3, 4, 5, 6, 100])
def test_diameter_is_right_where_many_edges_are_parallel(count: int) -> None:
    corners = regular_polygon(count)
    polygon = np.exp(0.3j) * np.column_stack([corners, (corners + np.roll(corners, -1)) / 2])
    largest = np.abs(corners[:, None] - corners).max()
    assert_allclose(diameter(polygon.ravel()), largest, rtol=1e-14, atol=0)


@pytest.mark.parametrize("scale", [1e-200, 1e-40, 1e40, 1e200])
def test_diameter_grows_with_the_polygon_at_any_scale(scale: float) -> None:
    polygon = np.exp(0.3j) * np.array([0, 1, 1 + 1j, 1j])
    assert_allclose(diameter(scale * polygon), scale * np.sqrt(2), rtol=1e-14, atol=0)


def test_diameter_of_points_on_a_line_is_its_length() -> None:
    assert diameter(np.array([1.0 + 1j, 3 + 3j, 2 + 2j])) == pytest.approx(2 * np.sqrt(2))
    assert diameter(np.array([5.0 + 0j])) == 0


def test_diameter_of_very_many_vertices_takes_little_memory() -> None:
    assert_allclose(diameter(np.exp(2j * np.pi * np.arange(20_000) / 20_000)), 2, rtol=1e-14)
