import numpy as np
from hypothesis import given, settings, strategies as st
from shapes import star_polygons

from engine.arrays import Complexes
from engine.domain.meshing.lattice import lattice_inside, lattice_triangles
from engine.domain.meshing.mesh import signed_areas
from engine.geometry.polygon import contains, distance_to_boundary


@settings(max_examples=25, deadline=None)
@given(outline=star_polygons(), spacing=st.floats(0.03, 0.4))
def test_the_points_are_all_lattice_points_inside(outline: Complexes, spacing: float) -> None:
    lattice = lattice_inside([outline], spacing)
    corner = complex(outline.real.min(), outline.imag.min())
    row, column = np.mgrid[0 : int(4 / spacing) + 1, -1 : int(4 / spacing) + 1]
    height = np.sqrt(0.75) * spacing
    every = corner + (column + row % 2 / 2) * spacing + 1j * (row + 0.5) * height
    every = every[distance_to_boundary(outline, every.ravel()).reshape(every.shape) > 1e-9]
    expected = every[contains(outline, every)]
    np.testing.assert_allclose(np.sort(lattice.points), np.sort(expected), rtol=0, atol=1e-12)


@settings(max_examples=25, deadline=None)
@given(outline=star_polygons(), spacing=st.floats(0.12, 0.4))
def test_the_triangles_are_all_unit_triangles_of_the_points(
    outline: Complexes, spacing: float
) -> None:
    lattice = lattice_inside([outline], spacing)
    triangles = lattice_triangles(lattice)
    unit = np.sqrt(3) / 4 * spacing**2
    np.testing.assert_allclose(signed_areas(lattice.points, triangles), unit, rtol=1e-9)
    apart = np.abs(lattice.points[:, None] - lattice.points)
    near = (np.abs(apart - spacing) < 1e-6 * spacing).astype(np.float64)
    np.testing.assert_allclose(len(triangles), np.trace(near @ near @ near) / 6, rtol=0, atol=1e-6)


def test_a_polygon_between_two_rows_has_no_points() -> None:
    lattice = lattice_inside([np.array([0, 1, 1 + 0.1j, 0.1j])], 0.5)
    assert len(lattice.points) == 0
    assert lattice_triangles(lattice).shape == (0, 3)
