import numpy as np
from numpy.testing import assert_array_equal
from shapes import regular_polygon

from engine.domain.meshing.draw_order import with_limbs_on_top
from engine.domain.meshing.mesh import Mesh
from engine.domain.meshing.triangulation import triangulate
from engine.geometry.polygon import deepest_point, signed_area

# A U, which a walk from its left tip to its right tip has to follow all the way round.
U = np.array([0, 3, 3 + 4j, 2 + 4j, 2 + 1j, 1 + 1j, 1 + 4j, 4j])


def test_triangles_come_in_the_order_of_their_way_from_the_centre():
    mesh = triangulate(U, 2000)
    ordered = with_limbs_on_top(mesh, 0.5 + 4j)
    assert_array_equal(ordered.vertices, mesh.vertices)
    assert_array_equal(np.unique(ordered.triangles, axis=0), np.unique(mesh.triangles, axis=0))
    middles = ordered.vertices[ordered.triangles].mean(axis=1)
    left = (middles.real < 1) & (middles.imag > 1.2)
    right = (middles.real > 2) & (middles.imag > 1.2)
    # Along the left limb downwards, then along the right one upwards, in spite of the short gap.
    assert np.flatnonzero(left).max() < np.flatnonzero(right).min()
    assert np.corrcoef(np.flatnonzero(left), -middles[left].imag)[0, 1] > 0.95
    assert np.corrcoef(np.flatnonzero(right), middles[right].imag)[0, 1] > 0.95


def test_both_ways_around_a_hole_are_ways_from_the_centre():
    outline, hole = regular_polygon(40), 0.6 * regular_polygon(30)[::-1]
    ordered = with_limbs_on_top(triangulate(outline, 2000, holes=[hole]), 0.8)
    turns = np.abs(np.angle(ordered.vertices[ordered.triangles].mean(axis=1)))
    assert np.corrcoef(np.arange(len(turns)), turns)[0, 1] > 0.99


def test_triangles_stay_counter_clockwise():
    mesh = Mesh(vertices=U, triangles=np.array([[3, 4, 2], [0, 1, 5]], dtype=np.int32))
    assert_array_equal(np.sort(with_limbs_on_top(mesh, 0).areas()), np.sort(mesh.areas()))


def test_the_deepest_point_of_a_rectangle_is_on_its_middle_line():
    rectangle = np.array([0, 10, 10 + 4j, 4j])
    point = deepest_point(rectangle)
    assert abs(point.imag - 2) < 2e-3
    assert signed_area(rectangle) == 40
