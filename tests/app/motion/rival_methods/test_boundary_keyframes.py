"""Keyframes by where the boundary goes: harmonic coordinates, and discrete harmonic maps."""

from functools import cache

import numpy as np
import pytest
from interpolation_shapes import bar, boundary_of, inner_points, letter_l, scattered_on
from meshed_shapes import meshed_bar, s_to_u
from numpy.testing import assert_allclose

from app.motion import (
    TriangulatedDomain,
    discrete_harmonic,
    harmonic_coordinate_maps,
    prepare_baseline,
)
from engine.domain.meshing.triangulation import triangulate
from engine.errors import EngineError
from engine.interpolation import prepare

OUTLINE, CAGE = letter_l()
RAISED = OUTLINE + 0.05 * OUTLINE**2 + 0.1j * OUTLINE.real**2


@cache
def raised():
    return harmonic_coordinate_maps(OUTLINE, CAGE, [OUTLINE, RAISED])


def test_affine_places_of_the_vertices_give_the_affine_map():
    maps, error = harmonic_coordinate_maps(OUTLINE, CAGE, [2j * OUTLINE + 0.5 * OUTLINE.conj() + 3])
    z = inner_points(OUTLINE, 50, 0)
    assert_allclose(maps[0](z), 2j * z + 0.5 * z.conj() + 3, rtol=0, atol=1e-11)
    assert error < 1e-12


def test_edges_go_straight_to_the_edges_between_the_targets():
    maps, error = raised()
    assert error < 3e-3
    along = scattered_on(OUTLINE, 7).reshape(len(OUTLINE), 7)
    part = (along - OUTLINE[:, None]) / (np.roll(OUTLINE, -1) - OUTLINE)[:, None]
    expected = RAISED[:, None] * (1 - part) + np.roll(RAISED, -1)[:, None] * part
    assert_allclose(maps[1](along.ravel()), expected.ravel(), rtol=0, atol=0.02)
    # Only beside the corners, where a harmonic function has singularities, is it off by so much.
    middle = np.abs(part - 0.5).real < 0.3
    assert_allclose(maps[1](along[middle]), expected[middle], rtol=0, atol=1e-3)


def test_a_discrete_harmonic_map_converges_to_the_closed_form():
    (_, f), _ = raised()
    errors = []
    for count in (300, 4800):
        mesh = triangulate(OUTLINE, count)
        domain = TriangulatedDomain.of(mesh.vertices, mesh.triangles)
        exact = f(mesh.vertices)
        changed = np.where(domain.border, exact, 0.0)
        errors.append(np.abs(discrete_harmonic(domain, changed) - exact).max())
    assert errors[1] < errors[0] / 4
    assert errors[1] < 1e-3


def test_all_variants_take_keyframes_by_harmonic_coordinates():
    maps, _ = raised()
    z = inner_points(OUTLINE, 20, 1)
    frame = prepare(maps, boundary_of((OUTLINE, maps[0].cage)), z, variant="scaled-eta").frame(1)
    assert_allclose(frame.positions, maps[1](z), rtol=0, atol=1e-10)


@pytest.mark.parametrize(("method", "fault"), [("arap", 0.5), ("mesh-eta", 0.8)])
def test_of_discrete_harmonic_keyframes_only_scaled_eta_becomes_integrable(method, fault):
    errors = []
    for count in (200, 800, 3200):
        mesh = meshed_bar(count)
        domain = TriangulatedDomain.of(mesh.vertices, mesh.triangles)
        keys = [discrete_harmonic(domain, f(mesh.vertices)) for f in s_to_u()]
        between = prepare_baseline(method, keys, mesh.vertices, mesh.triangles)
        errors.append(between.frame(0.5).poisson_error)
    # Four times as many triangles are half as large.
    order = np.polyfit(np.arange(3), -np.log2(errors), 1)[0]
    assert (order > fault) == (method == "mesh-eta")


def test_positions_that_do_not_fit_are_refused():
    with pytest.raises(EngineError, match="keyframe 1 has 3 positions, but the outline has 24"):
        harmonic_coordinate_maps(OUTLINE, CAGE, [OUTLINE, OUTLINE[:3]])
    mesh = triangulate(bar()[0], 100)
    domain = TriangulatedDomain.of(mesh.vertices, mesh.triangles)
    with pytest.raises(EngineError, match="positions, not 5"):
        discrete_harmonic(domain, np.arange(5))
