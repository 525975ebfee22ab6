import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.spatial import Delaunay
from shapes import points_inside_disc

from engine.domain.meshing.half_edges import OUTLINE, HalfEdgeMesh, disjoint, following, preceding
from engine.domain.meshing.mesh import signed_areas, smallest_angles
from engine.domain.meshing.refinement import refine_mesh
from engine.domain.meshing.smoothing import smooth_mesh
from engine.geometry.polygon import as_xy

SQUARE = np.array([0, 1, 1 + 1j, 1j]) * 0.5
HALVES = np.array([[0, 1, 2], [0, 2, 3]])


def assert_consistent(mesh: HalfEdgeMesh, area: float) -> None:
    half_edges = np.arange(3 * mesh.count)
    inner = half_edges[mesh.counterparts >= 0]
    np.testing.assert_array_equal(mesh.counterparts[mesh.counterparts[inner]], inner)
    start, end = mesh.ends(half_edges)
    np.testing.assert_array_equal(start[mesh.counterparts[inner]], end[inner])
    np.testing.assert_array_equal(end[mesh.counterparts[inner]], start[inner])
    areas = signed_areas(mesh.points, mesh.triangles)
    assert np.all(areas > 0)
    np.testing.assert_allclose(areas.sum(), area, rtol=1e-12)


def square_with(points: np.ndarray) -> HalfEdgeMesh:
    """Insert points into the square one by one."""
    mesh = HalfEdgeMesh(SQUARE, HALVES)
    for vertex in mesh.add_points(points):
        place, exits = mesh.walk(np.array([0]), mesh.points[[vertex]])
        assert exits[0] == -1
        inserted, suspects = mesh.insert_where_possible(np.array([vertex]), place)
        assert inserted.all()
        mesh.restore_delaunay(suspects)
    return mesh


def test_following_and_preceding_go_round_each_triangle() -> None:
    np.testing.assert_array_equal(following(np.arange(6)), [1, 2, 0, 4, 5, 3])
    np.testing.assert_array_equal(preceding(following(np.arange(6))), np.arange(6))


def test_counterparts_are_found_by_the_ends() -> None:
    mesh = HalfEdgeMesh(SQUARE, HALVES)
    np.testing.assert_array_equal(mesh.counterparts, [OUTLINE, OUTLINE, 3, 2, OUTLINE, OUTLINE])


def test_a_flip_exchanges_the_diagonal() -> None:
    mesh = HalfEdgeMesh(SQUARE, HALVES)
    mesh.flip(np.array([2]))
    assert_consistent(mesh, 0.25)
    corners = {frozenset(map(int, row)) for row in mesh.triangles}
    assert corners == {frozenset({0, 1, 3}), frozenset({1, 2, 3})}
    np.testing.assert_array_equal(HALVES, [[0, 1, 2], [0, 2, 3]])


def test_splits_of_neighbours_at_once_keep_the_counterparts() -> None:
    mesh = HalfEdgeMesh(SQUARE, HALVES)
    vertices = mesh.add_points(np.array([0.3 + 0.1j, 0.1 + 0.3j]))
    mesh.insert(vertices, np.array([0, 1]))
    assert_consistent(mesh, 0.25)
    border = np.flatnonzero(mesh.counterparts == OUTLINE)
    middle = mesh.add_points(np.mean(mesh.end_points(border), axis=0))
    mesh.split_border(middle, border)
    assert_consistent(mesh, 0.25)
    assert mesh.count == 10
    assert np.count_nonzero(mesh.counterparts == OUTLINE) == 8


def test_two_points_on_one_edge_from_both_sides_make_no_flat_triangle() -> None:
    mesh = HalfEdgeMesh(SQUARE, HALVES)
    vertices = mesh.add_points(np.array([0.2 + 0.2j, 0.3 + 0.3j]))
    inserted, suspects = mesh.insert_where_possible(vertices, np.array([0, 1]))
    assert inserted.sum() == 1
    mesh.restore_delaunay(suspects)
    assert_consistent(mesh, 0.25)


def test_of_rows_with_a_common_triangle_the_last_one_is_chosen() -> None:
    chosen = disjoint(np.array([0, 1, 2, 5]), np.array([-1, 2, 3, -1]), among=6)
    np.testing.assert_array_equal(chosen, [True, False, True, True])


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 60))
def test_inserting_points_gives_the_delaunay_triangulation(seed: int, count: int) -> None:
    points = points_inside_disc(0.24, count, seed) + 0.25 + 0.25j
    mesh = square_with(points)
    assert_consistent(mesh, 0.25)
    expected = Delaunay(as_xy(mesh.points)).simplices
    found = {frozenset(map(int, row)) for row in mesh.triangles}
    assert found == {frozenset(map(int, row)) for row in expected}


def test_lattice_points_which_lie_on_each_others_edges_are_inserted() -> None:
    column, row = np.meshgrid(np.arange(1, 8), np.arange(1, 8))
    mesh = square_with((column + 1j * row).ravel() / 16)
    assert_consistent(mesh, 0.25)
    np.testing.assert_allclose(smallest_angles(mesh.points, mesh.triangles).max(), 45, rtol=1e-9)
    assert mesh.count == 2 * (49 + 4) - 4 - 2


def test_waiting_vertices_are_followed_through_insertions_and_flips() -> None:
    mesh = HalfEdgeMesh(SQUARE, HALVES)
    mesh.waiting = mesh.add_points(points_inside_disc(0.24, 200, 1) + 0.25 + 0.25j)
    mesh.places, _ = mesh.walk(np.zeros(200, dtype=np.intp), mesh.points[mesh.waiting])
    for _ in range(3):
        inserted, suspects = mesh.insert_where_possible(mesh.waiting, mesh.places)
        mesh.waiting, mesh.places = mesh.waiting[~inserted], mesh.places[~inserted]
        mesh.restore_delaunay(suspects)
    found, exits = mesh.walk(mesh.places, mesh.points[mesh.waiting])
    assert len(found) > 100
    np.testing.assert_array_equal(found, mesh.places)
    assert np.all(exits == -1)


def test_a_walk_ends_at_the_border_that_hides_its_target() -> None:
    mesh = square_with(points_inside_disc(0.24, 100, 2) + 0.25 + 0.25j)
    start, _ = mesh.walk(np.array([0]), np.array([0.25 + 0.25j]))
    _, exits = mesh.walk(start, np.array([0.9 + 0.25j]))
    assert mesh.counterparts[exits[0]] == OUTLINE
    assert set(mesh.origins[[exits[0], following(exits)[0]]]) == {1, 2}


def test_a_walk_goes_straight_and_not_around_what_hides_its_target() -> None:
    # In a U: past the inner corner at the lower left (vertex 5), the line leaves the left leg.
    outline = np.array([0, 3, 3 + 4j, 2 + 4j, 2 + 1j, 1 + 1j, 1 + 4j, 4j]) / 8
    legs = np.array([[0, 5, 7], [5, 6, 7], [0, 1, 4], [0, 4, 5], [1, 2, 4], [2, 3, 4]])
    mesh = HalfEdgeMesh(outline, legs)
    _, exits = mesh.walk(np.array([0]), np.array([2.5 + 0.3j]) / 8)
    np.testing.assert_array_equal(mesh.ends(exits), [[5], [6]])


@pytest.mark.parametrize(("smallest", "most"), [(20.0, 36), (28.0, 90)])
def test_refinement_leaves_no_small_angle_and_is_sparing(smallest: float, most: int) -> None:
    mesh = square_with(np.array([0.02 + 0.01j, 0.021 + 0.012j]))
    refine_mesh(mesh, smallest)
    assert_consistent(mesh, 0.25)
    assert smallest_angles(mesh.points, mesh.triangles).min() >= smallest
    assert mesh.count <= most
    border = mesh.points[mesh.origins[mesh.counterparts == OUTLINE]]
    nearest = np.min([border.real, border.imag, 0.5 - border.real, 0.5 - border.imag], axis=0)
    np.testing.assert_allclose(nearest, 0, rtol=0, atol=1e-15)


def test_smoothing_improves_the_mean_and_keeps_corners_and_border() -> None:
    mesh = square_with(points_inside_disc(0.24, 300, 3) + 0.25 + 0.25j)
    refine_mesh(mesh, 20.0)
    before = smallest_angles(mesh.points, mesh.triangles)
    smooth_mesh(mesh, 4, 5)
    after = smallest_angles(mesh.points, mesh.triangles)
    assert_consistent(mesh, 0.25)
    np.testing.assert_array_equal(mesh.points[:4], SQUARE)
    assert after.mean() > before.mean() + 2
    assert after.min() >= before.min()


def test_smoothing_leaves_the_mesh_delaunay() -> None:
    mesh = square_with(points_inside_disc(0.24, 300, 3) + 0.25 + 0.25j)
    smooth_mesh(mesh, 4, 1)
    corners = mesh.triangles.copy()
    mesh.restore_delaunay(np.arange(3 * mesh.count))
    np.testing.assert_array_equal(mesh.triangles, corners)


def test_smoothing_does_not_pull_a_vertex_out_of_a_notched_outline() -> None:
    # The mean of the four vertices around the inner one lies below the notch.
    arrowhead = np.array([-0.4 - 0.4j, 0.3j, 0.4 - 0.4j, 0.5j, 0.4j])
    fan = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    mesh = HalfEdgeMesh(arrowhead, fan)
    smooth_mesh(mesh, 4, 3)
    assert_consistent(mesh, 0.08)
