"""What the methods have in common, and how far each keeps what the paper's variants keep."""

import numpy as np
import pytest
from interpolation_shapes import bar, bent, boundary_of
from meshed_shapes import k_of, meshed_bar, rigid, s_to_u, stretched_pair
from messages import says
from numpy.testing import assert_allclose

from app.document import Baseline
from app.motion import prepare_baseline
from app.motion.rival_methods.mesh_keyframes import WINDS
from engine.domain.meshing.triangulation import triangulate
from engine.errors import EngineError
from engine.geometry.polygon import OUTSIDE_OUTLINE
from engine.interpolation import prepare

MESH = meshed_bar()
OUTLINE, _ = bar(0.25)
HANDLES = np.array([-1.8, 0.0, 1.8])
EXACT = [name for name in Baseline if name is not Baseline.HANDLES]
ON_MESHES = [name for name in Baseline if not name.needs_maps]


def prepared(name, maps, mesh=MESH, **options):
    return prepare_baseline(
        name, maps, mesh.vertices, mesh.triangles, outline=OUTLINE, handles=HANDLES, **options
    )


def pair_for(name):
    if name is Baseline.CONFORMAL:
        return [bent(bar(0.25)), bent(bar(0.25), bend=1.2, turn=2.5, shift=1 + 1j)]
    return stretched_pair()


@pytest.mark.parametrize("name", EXACT)
def test_keyframes_come_out_exactly(name):
    maps = pair_for(name)
    between = prepared(name, maps)
    for time, f in enumerate(maps):
        assert_allclose(between.frame(time).positions, f(MESH.vertices), rtol=0, atol=1e-8)


@pytest.mark.parametrize("name", ON_MESHES)
def test_keyframes_that_are_meshes_do_the_same_as_maps(name):
    maps = stretched_pair()
    positions = [f(MESH.vertices) for f in maps]
    assert_allclose(
        prepared(name, positions).frame(0.4).positions,
        prepared(name, maps).frame(0.4).positions,
        rtol=0,
        atol=1e-12,
    )


@pytest.mark.parametrize("turn", [2.5, -3.1])
@pytest.mark.parametrize("name", EXACT)
def test_a_rigid_motion_is_interpolated_as_a_rotation_about_the_anchor(name, turn):
    maps = [rigid(0.4, 0j), rigid(0.4 + turn, 3 + 1j)]
    between = prepared(name, maps, anchor=0.5)
    z = MESH.vertices
    centre = z[between.domain.anchor]
    before, after = (f(np.array([centre]))[0] for f in maps)
    expected = 0.7 * before + 0.3 * after + np.exp(1j * (0.4 + 0.3 * turn)) * (z - centre)
    assert_allclose(between.frame(0.3).positions, expected, rtol=0, atol=1e-8)


@pytest.mark.parametrize("name", ON_MESHES)
def test_three_keyframes_and_a_loop_pass_every_keyframe_once(name):
    first, second = stretched_pair()
    maps = [first, rigid(0.3, 0j), second]
    between = prepared(name, maps, loop=True)
    assert len(between.segments) == 3
    for time, f in enumerate([*maps, first]):
        assert_allclose(between.frame(time).positions, f(MESH.vertices), rtol=0, atol=1e-8)


@pytest.mark.parametrize("name", EXACT)
def test_in_between_has_the_derivatives_of_its_triangles(name):
    between = prepared(name, pair_for(name))
    frame = between.frame(0.4)
    corners = between.domain.corners.T
    z, w = MESH.vertices[corners], frame.positions[corners]
    for k in (1, 2):
        dz, dw = z[k] - z[0], w[k] - w[0]
        assert_allclose(frame.fz * dz + frame.fzbar * dz.conj(), dw, rtol=0, atol=1e-12)


@pytest.mark.parametrize("count", [1500, 4000])
@pytest.mark.parametrize(("name", "least"), [("arap", 1.1), ("ffmp", 1.2)])
def test_arap_and_ffmp_leave_the_bounds_of_s_to_u(name, least, count):
    mesh, maps = meshed_bar(count), s_to_u()
    between = prepared(name, maps, mesh)
    ends = np.max([k_of(*between.domain.derivatives(f(mesh.vertices))) for f in maps], axis=0)
    times = np.linspace(0.2, 0.8, 4)
    frames = [between.frame(time) for time in times]
    assert max((k_of(f.fz, f.fzbar) / ends).max() for f in frames) > least


@pytest.mark.parametrize("variant", ["nu", "scaled-eta", "metric"])
def test_our_variants_keep_the_bounds_of_s_to_u(variant):
    maps = s_to_u()
    boundary = boundary_of(bar(0.25))
    between = prepare(maps, boundary, MESH.vertices, variant=variant, triangles=MESH.triangles)
    ends = np.max([k_of(*f.derivatives(MESH.vertices)) for f in maps], axis=0)
    for time in np.linspace(0.2, 0.8, 4):
        frame = between.frame(time)
        assert (k_of(frame.fz, frame.fzbar) / ends).max() < 1 + 1e-4


def test_linear_in_betweens_shrink_where_all_others_do_not():
    maps = [rigid(0.0, 0j), rigid(3.0, 0j)]
    linear = prepare(
        maps, boundary_of(bar(0.25)), MESH.vertices, variant="linear", triangles=MESH.triangles
    ).frame(0.5)
    assert np.abs(linear.fz).max() < 0.1
    for name in EXACT:
        frame = prepared(name, maps).frame(0.5)
        assert_allclose(np.abs(frame.fz), 1.0, rtol=0, atol=1e-8)


def ring():
    mesh = triangulate(2 * np.exp(2j * np.pi * np.arange(48) / 48), 1500)
    kept = (np.abs(mesh.vertices[mesh.triangles]) > 0.8).all(axis=1)
    used, triangles = np.unique(mesh.triangles[kept], return_inverse=True)
    return mesh.vertices[used], triangles.reshape(-1, 3)


@pytest.mark.parametrize("name", ["arap", "ffmp", "mesh-eta"])
def test_a_mesh_with_a_hole_is_turned_and_stretched(name):
    z, triangles = ring()
    keys = [z, 1.2j * z + 0.3 * z.conj()]
    between = prepare_baseline(name, keys, z, triangles)
    assert between.domain.loops == 2
    frame = between.frame(0.5)
    assert frame.poisson_error < 1e-10
    assert_allclose(frame.fz, frame.fz[0], rtol=1e-9, atol=0)


def test_a_keyframe_that_winds_around_a_hole_is_refused():
    z, triangles = ring()
    with pytest.raises(EngineError, match=says(WINDS, number=1, turns=1)):
        prepare_baseline("arap", [z, z**2], z, triangles)


def test_a_keyframe_whose_triangles_wind_twice_around_a_vertex_folds():
    rim = np.exp(2j * np.pi * np.arange(8) / 8)
    triangles = [[0, 1 + i, 1 + (i + 1) % 8] for i in range(8)]
    keys = [np.append(0, rim), np.append(0, rim**2)]
    with pytest.raises(EngineError, match="around point 0 overlap"):
        prepare_baseline("arap", keys, keys[0], triangles)


def test_points_outside_the_outline_are_refused():
    far = MESH.vertices + 0.1
    with pytest.raises(EngineError, match=says(OUTSIDE_OUTLINE)):
        prepare_baseline("arap", stretched_pair(), far, MESH.triangles, outline=OUTLINE)


@pytest.mark.parametrize("name", ON_MESHES)
def test_the_least_mesh_is_one_triangle(name):
    z = np.array([0, 1, 1j])
    between = prepare_baseline(name, [z, 2j * z + 1], z, [[0, 1, 2]])
    assert_allclose(between.frame(1.0).positions, 2j * z + 1, rtol=0, atol=1e-12)
    assert np.all(np.abs(between.frame(0.5).fz) > 1)


def test_handles_that_go_straight_keep_their_bounds_and_shrink_a_turning_bar():
    # The handles at both ends change places: halfway they are wanted at one point.
    maps = [rigid(0.0, 0j), rigid(2.8, 0j)]
    between = prepared("handles", maps)
    assert_allclose(between.frame(0.0).positions, MESH.vertices, rtol=0, atol=1e-4)
    frame = between.frame(0.5)
    assert (np.abs(frame.fz) - np.abs(frame.fzbar)).min() > 0
    assert np.abs(frame.fz).mean() < 0.8
