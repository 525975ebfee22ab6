import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from engine.domain.meshing.depth import find_paths, sort_by_depth, spread_depth
from engine.domain.meshing.triangulation import triangulate

SQUARE = np.array([0, 1, 1 + 1j, 1j])
# A U whose arms are 0.2 apart.
U = np.array([0, 1, 1 + 2j, 0.6 + 2j, 0.6 + 0.4j, 0.4 + 0.4j, 0.4 + 2j, 2j])


def spread(mesh, point, extent, depth=1.0):
    return spread_depth(mesh, find_paths(mesh), np.array([point]), [depth], [extent])


def test_depth_is_whole_near_its_point_and_falls_smoothly_to_nothing():
    mesh = triangulate(SQUARE, 20_000)
    depths = spread(mesh, 0.5 + 0.5j, 0.4, depth=-0.8)
    away = np.abs(mesh.vertices - (0.5 + 0.5j))
    assert_allclose(depths[away < 0.19], -0.8, atol=1e-6)
    assert_array_equal(depths[away > 0.41], 0.0)
    # Half way down at three quarters of the extent; ways are at most a few percent too long.
    middle = (away > 0.285) & (away < 0.3)
    assert np.all(np.abs(depths[middle] + 0.4) < 0.12)
    assert np.all((depths >= -0.8) & (depths <= 0))


def test_ways_are_nearly_as_short_as_they_can_be():
    mesh = triangulate(SQUARE, 20_000)
    # The depth is monotone in the way, and 0.5 at three quarters of the extent.
    for extent in (0.2, 0.4):
        half = np.abs(spread(mesh, 0.5 + 0.5j, extent) - 0.5) < 0.05
        away = np.abs(mesh.vertices[half] - (0.5 + 0.5j))
        assert away.max() / away.min() < 1.12


def test_depth_goes_along_the_shape_and_never_across_a_gap():
    mesh = triangulate(U, 8_000)
    left, right = mesh.vertices.real <= 0.4, mesh.vertices.real >= 0.6
    depths = spread(mesh, 0.2 + 1.8j, 1.0)
    assert depths[left].max() == pytest.approx(1.0, abs=1e-6)
    assert_array_equal(depths[right], 0.0)
    # Far enough it comes round.
    round_it = spread(mesh, 0.2 + 1.8j, 8.0)
    assert round_it[right].min() > 0.9


def test_every_point_keeps_its_own_depth():
    mesh = triangulate(SQUARE, 8_000)
    points, depths = np.array([0.3 + 0.5j, 0.5 + 0.5j, 0.9 + 0.9j]), [1.0, -0.5, 0.25]
    spread = spread_depth(mesh, find_paths(mesh), points, depths, [0.35, 0.35, 0.1])
    for point, depth in zip(points, depths, strict=True):
        nearest = np.argmin(np.abs(mesh.vertices - point))
        assert spread[nearest] == pytest.approx(depth, abs=1e-6)
    assert spread.min() >= -0.5 - 1e-9
    assert spread.max() <= 1.0 + 1e-9


def test_without_points_nothing_is_in_front():
    mesh = triangulate(SQUARE, 1_000)
    depths = spread_depth(mesh, find_paths(mesh), np.array([], complex), [], [])
    assert_array_equal(depths, 0.0)
    assert_array_equal(sort_by_depth(mesh, depths), mesh.triangles)


def test_what_is_deeper_is_painted_earlier_and_the_rest_stays_in_order():
    mesh = triangulate(U, 8_000)
    depths = spread(mesh, 0.2 + 1.8j, 0.8) - spread(mesh, 0.8 + 1.8j, 0.8)
    ordered = sort_by_depth(mesh, depths)
    assert not ordered.flags.writeable
    assert_array_equal(np.unique(ordered, axis=0), np.unique(mesh.triangles, axis=0))
    middles = depths[ordered].mean(axis=1)
    assert np.all(np.diff(middles) > -2e-3)
    level = depths[mesh.triangles].any(axis=1)
    still = [tuple(t) for t in mesh.triangles[~level].tolist()]
    kept = set(still)
    assert [tuple(t) for t in ordered.tolist() if tuple(t) in kept] == still
