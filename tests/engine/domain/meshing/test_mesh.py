import numpy as np

from engine.domain.meshing.mesh import Mesh, sides_of

RHOMBUS = Mesh(
    vertices=np.array([0, 1, 0.5 + np.sqrt(0.75) * 1j, 1.5 + np.sqrt(0.75) * 1j]),
    triangles=np.array([[0, 1, 2], [3, 2, 1]], dtype=np.int32),
)


def test_areas_are_signed() -> None:
    np.testing.assert_allclose(RHOMBUS.areas(), np.sqrt(3) / 4, rtol=1e-14)
    turned = Mesh(vertices=RHOMBUS.vertices, triangles=RHOMBUS.triangles[:, ::-1])
    np.testing.assert_allclose(turned.areas(), -np.sqrt(3) / 4, rtol=1e-14)


def test_smallest_angles_are_in_degrees_and_zero_where_flat() -> None:
    np.testing.assert_allclose(RHOMBUS.smallest_angles(), 60, rtol=1e-14)
    three = np.array([[0, 1, 2]], dtype=np.int32)
    right = Mesh(vertices=np.array([0, np.sqrt(3), 1j]), triangles=three)
    np.testing.assert_allclose(right.smallest_angles(), [30], rtol=1e-14)
    flat = Mesh(vertices=np.array([0, 1, 3 + 0j]), triangles=three)
    np.testing.assert_allclose(flat.smallest_angles(), [0], rtol=0, atol=1e-14)


def test_edges_are_undirected_and_unique() -> None:
    edges = RHOMBUS.edges()
    assert edges.dtype == np.int32
    np.testing.assert_array_equal(edges, [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]])


def test_counterparts_run_along_one_edge_in_opposite_directions() -> None:
    sides, numbers, counterparts = sides_of(RHOMBUS.triangles)
    np.testing.assert_array_equal(sides, RHOMBUS.edges())
    ends = np.stack([RHOMBUS.triangles, np.roll(RHOMBUS.triangles, -1, axis=1)], axis=-1)
    np.testing.assert_array_equal(sides[numbers], np.sort(ends, axis=-1))
    np.testing.assert_array_equal(counterparts, [[1, 4]])
    here, there = ends.reshape(-1, 2)[counterparts[0]]
    np.testing.assert_array_equal(here, there[::-1])


def test_a_mesh_is_read_only_and_keeps_the_given_arrays_writable() -> None:
    vertices = np.array([0, 1, 1j])
    mesh = Mesh(vertices=vertices, triangles=np.array([[0, 1, 2]], dtype=np.int32))
    vertices[0] = 5
    assert mesh.vertices[0] == 0
    assert not mesh.vertices.flags.writeable
    assert not mesh.triangles.flags.writeable
