import numpy as np
import pytest
import shapely
from hypothesis import given, settings, strategies as st
from interpolation_shapes import bar, inner_points, letter_l, narrow_u, random_map, spiral
from messages import says
from numpy.testing import assert_allclose, assert_array_equal
from shapes import regular_polygon, star_polygons

from engine.domain.meshing.triangulation import triangulate
from engine.errors import EngineError
from engine.geometry.polygon import as_xy, contains, diameter, edge_vectors
from engine.maps.cauchy import evaluate
from engine.paths import integration_paths
from engine.paths.integration_paths import lay_paths
from engine.paths.path_network import (
    ANCHOR_UNREACHED,
    EDGE_LEAVES,
    MESH_POINTS,
    Network,
    mesh_network,
    scattered_network,
)
from engine.paths.spanning_tree import SpanningTree, breadth_first_parents, depth_first_numbering


def random_tree(seed, count):
    rng = np.random.default_rng(seed)
    parents = np.array([0] + [rng.integers(0, i) for i in range(1, count)])
    numbering = depth_first_numbering(parents, 0)
    new = np.empty(count, dtype=np.intp)
    new[numbering] = np.arange(count)
    return new[parents[numbering]]


@given(seed=st.integers(0, 10_000), count=st.integers(1, 60))
@settings(max_examples=40)
def test_sums_along_paths(seed, count):
    parents = random_tree(seed, count)
    steps = np.random.default_rng(seed).normal(size=count) * (1 + 2j)
    sums = SpanningTree.of_parents(parents).sums(steps)
    for node in range(count):
        total, at = steps[0], node
        while at != 0:
            total += steps[at]
            at = parents[at]
        assert_allclose(sums[node], total, rtol=0, atol=1e-12)


def test_breadth_first_paths_are_shortest_and_reach_what_can_be_reached():
    links = np.array([[0, 1], [1, 2], [3, 0], [6, 3], [2, 6], [6, 7], [7, 3], [4, 5]])
    parents = breadth_first_parents(8, links, 1)
    assert_array_equal(parents[:7], [1, 1, 1, 0, -1, -1, 2])


def networks(outline, seed):
    """Return a mesh's network and one of scattered points of the same outline."""
    mesh = triangulate(outline, 300)
    anchor = inner_points(outline, 1, seed)
    thirds = outline + edge_vectors(outline) / 3
    scattered = np.concatenate([inner_points(outline, 60, seed), outline, thirds])
    return (
        mesh_network(outline, mesh.vertices, mesh.triangles, anchor),
        scattered_network(outline, scattered, anchor),
    )


@pytest.mark.parametrize("shape", [bar(), letter_l(), narrow_u(), narrow_u(0.002), spiral()])
def test_paths_stay_inside_and_reach_every_point(shape):
    outline, cage = shape
    room = shapely.Polygon(as_xy(outline)).buffer(1e-8)
    shapely.prepare(room)
    for network in networks(outline, 4):
        paths = lay_paths(network, outline, cage)
        assert_array_equal(paths.nodes[paths.places], network.nodes[network.places])
        ends = np.stack([as_xy(paths.nodes[paths.tree.parent]), as_xy(paths.nodes)], axis=1)
        assert shapely.covers(room, shapely.linestrings(ends[1:])).all()
        reached = paths.nodes[0] + paths.tree.sums(paths.steps)
        assert_allclose(reached, paths.nodes, rtol=0, atol=1e-12)


@given(polygon=star_polygons(), seed=st.integers(0, 1000))
@settings(max_examples=15)
def test_scattered_points_are_reached_in_any_polygon(polygon, seed):
    points = np.concatenate([inner_points(polygon, 20, seed), polygon])
    cage = 3 * polygon
    paths = lay_paths(scattered_network(polygon, points, points[:1]), polygon, cage)
    reached = paths.nodes[0] + paths.integrals(paths.steps)
    assert_allclose(reached, points, rtol=0, atol=1e-12)


def test_the_same_point_many_times_and_the_anchor_among_them():
    outline, cage = letter_l()
    points = np.array([0.3 + 0.3j] * 4 + [2 + 0.5j] * 3 + list(outline[:2]) * 2)
    paths = lay_paths(scattered_network(outline, points, points[:1]), outline, cage)
    assert_allclose(points[0] + paths.integrals(paths.steps), points, rtol=0, atol=1e-13)


def test_points_a_billionth_outside_are_reached():
    outline, cage = bar()
    points = outline + 0.3 * edge_vectors(outline) - 3e-9j * edge_vectors(outline)
    paths = lay_paths(scattered_network(outline, points, np.array([0j])), outline, cage)
    assert_allclose(paths.integrals(paths.steps), points, rtol=0, atol=1e-12)


def test_steps_are_short_near_singularities():
    outline, cage = letter_l()
    for network in networks(outline, 0):
        paths = lay_paths(network, outline, cage)
        middles = paths.nodes - paths.steps / 2
        lengths = np.abs(paths.steps)
        scale = diameter(outline)
        to_cage = np.abs(middles[:, None] - cage).min(axis=1)
        assert lengths.max() <= integration_paths.STEP_PER_SIZE * scale
        assert np.all(lengths <= integration_paths.STEP_PER_DISTANCE * to_cage)


def test_the_quadrature_is_of_fourth_order(monkeypatch):
    outline, cage = bar()
    f = random_map(bar(), 3)
    points = inner_points(outline, 50, 0, margin=0.1)
    # The bar is convex: every point is one straight leg away from the anchor.
    network = Network(
        nodes=np.concatenate([[0j], points]),
        parents=np.zeros(51, dtype=np.intp),
        places=np.arange(1, 51),
    )
    (phi,) = evaluate(cage, f.phi[:, None], network.nodes, orders=(0,))
    monkeypatch.setattr(integration_paths, "STEP_PER_DISTANCE", 100.0)
    errors = []
    for longest in (1 / 16, 1 / 32, 1 / 64, 1 / 128):
        monkeypatch.setattr(integration_paths, "STEP_PER_SIZE", longest)
        paths = lay_paths(network, outline, cage)
        fz, _ = f.derivatives(paths.nodes)
        (fzz,) = evaluate(cage, f.phi[:, None], paths.nodes, orders=(2,))
        integrals = paths.integrals(paths.step_integrals(fz, fzz[:, 0]))
        errors.append(np.abs(integrals - (phi[1:] - phi[0])[:, 0]).max())
    # Slopes of the logarithm of the error against that of the step.
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 3.5)
    assert errors[-1] < 1e-6


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: np.vstack([t, [[0, 1, 10_000]]]), says(MESH_POINTS)),
        (lambda t: np.vstack([t, [[-1, 1, 2]]]), says(MESH_POINTS)),
        (lambda t: t[:2], "No triangles connect"),
    ],
)
def test_triangles_that_do_not_fit_are_refused(change, message):
    outline, _ = letter_l()
    mesh = triangulate(outline, 300)
    triangles = change(mesh.triangles).astype(np.int32)
    with pytest.raises(EngineError, match=message):
        mesh_network(outline, mesh.vertices, triangles, mesh.vertices[mesh.triangles[0, :1]])


def test_triangles_across_the_outside_are_refused():
    outline, _ = narrow_u()
    # From one leg of the U to the other.
    vertices = np.array([-0.5 + 1.5j, 0.5 + 1.5j, 0.3j])
    with pytest.raises(EngineError, match=says(EDGE_LEAVES, first=0, second=1)):
        mesh_network(outline, vertices, np.array([[0, 2, 1]], np.int32), vertices[2:])


def test_triangles_across_the_outside_are_refused_whichever_way_they_run():
    outline, _ = narrow_u()
    # The same triangle twice, one of them reversed: no edge is at the border of anything.
    vertices = np.array([-0.5 + 1.5j, 0.5 + 1.5j, 0.3j])
    both = np.array([[0, 2, 1], [0, 1, 2]], np.int32)
    with pytest.raises(EngineError, match=says(EDGE_LEAVES, first=0, second=1)):
        mesh_network(outline, vertices, both, vertices[2:])
    mesh = triangulate(outline, 300)
    anchor = mesh.vertices[mesh.triangles[0, :1]]
    networks = [
        mesh_network(outline, mesh.vertices, triangles, anchor)
        for triangles in (mesh.triangles, mesh.triangles[:, ::-1])
    ]
    assert_array_equal(networks[0].parents, networks[1].parents)


def test_an_anchor_far_from_a_partial_mesh_is_refused():
    outline, _ = narrow_u()
    vertices = np.array([-0.8 + 1.5j, -0.5 + 1.5j, -0.5 + 1.8j])
    with pytest.raises(EngineError, match=says(ANCHOR_UNREACHED)):
        mesh_network(outline, vertices, np.array([[0, 1, 2]], np.int32), np.array([0.5 + 1.5j]))


HOLES = (
    -1.2 + 0.3 * regular_polygon(24)[::-1],
    0.02j + 0.45 * regular_polygon(30)[::-1],
    1.3 + 0.1 * regular_polygon(12)[::-1],
)


@pytest.mark.parametrize("holes", [HOLES[:1], HOLES])
def test_paths_go_around_holes_and_reach_every_point(holes):
    outline, cage = bar()
    room = shapely.Polygon(as_xy(outline), [as_xy(hole) for hole in holes]).buffer(1e-8)
    shapely.prepare(room)
    mesh = triangulate(outline, 600, holes=holes)
    anchor = np.array([-1.7 + 0j])
    rng = np.random.default_rng(0)
    points = rng.uniform(-2, 2, 400) + 1j * rng.uniform(-0.5, 0.5, 400)
    points = np.concatenate([points[contains(outline, points, holes=holes)], *holes])
    for network in (
        mesh_network(outline, mesh.vertices, mesh.triangles, anchor, holes=holes),
        scattered_network(outline, points, anchor, holes=holes),
    ):
        paths = lay_paths(network, np.concatenate([outline, *holes]), cage)
        ends = np.stack([as_xy(paths.nodes[paths.tree.parent]), as_xy(paths.nodes)], axis=1)
        assert shapely.covers(room, shapely.linestrings(ends[1:])).all()
        # 1/(z - c) is integrated to a logarithm, but for the ways that pass on the other side.
        centre = holes[0].mean()
        slopes = -1 / (paths.nodes - centre) ** 2
        steps = paths.step_integrals(1 / (paths.nodes - centre), slopes)
        logarithms = paths.integrals(steps)
        ends_at = paths.nodes[paths.places]
        turns = (logarithms - np.log((ends_at - centre) / (anchor - centre))) / (2j * np.pi)
        assert_allclose(turns, np.round(turns.real), rtol=0, atol=1e-6)


def test_triangles_across_a_hole_are_refused():
    outline, _ = bar()
    mesh = triangulate(outline, 600)
    with pytest.raises(EngineError, match="leaves the outline"):
        mesh_network(outline, mesh.vertices, mesh.triangles, np.array([-1.7 + 0j]), holes=HOLES)
