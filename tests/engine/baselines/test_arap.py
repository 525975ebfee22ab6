"""As-rigid-as-possible interpolation: facts of Alexa, Cohen-Or and Levin (2000)."""

import numpy as np
import pytest
from interpolation_shapes import bar, bent
from meshed_shapes import meshed, rigid
from numpy.testing import assert_allclose

from engine.baselines import prepare_baseline

MESH = meshed("bar")


def prepared(maps, **options):
    return prepare_baseline("arap", maps, MESH.vertices, MESH.triangles, **options)


def bent_pair():
    return [bent(bar()), bent(bar(), bend=1.2, turn=2.5, stretch=1.4, shift=1 + 1j)]


def test_keyframes_come_out_exactly():
    maps = bent_pair()
    between = prepared(maps)
    for time, f in enumerate(maps):
        frame = between.frame(time)
        assert_allclose(frame.positions, f(MESH.vertices), rtol=0, atol=1e-11)
        assert frame.poisson_error < 1e-12


@pytest.mark.parametrize("turn", [2.5, -3.1])
def test_a_rigid_motion_is_interpolated_as_a_rotation_about_the_anchor(turn):
    between = prepared([rigid(0.4, 0j), rigid(0.4 + turn, 3 + 1j)], anchor=0.5)
    z = MESH.vertices
    start = z[between.domain.anchor]
    before, after = (rigid(0.4 + a, s)(np.array([start]))[0] for a, s in ((0, 0j), (turn, 3 + 1j)))
    frame = between.frame(0.3)
    expected = 0.7 * before + 0.3 * after + np.exp(1j * (0.4 + 0.3 * turn)) * (z - start)
    assert_allclose(frame.positions, expected, rtol=0, atol=1e-11)
    assert frame.poisson_error < 1e-12


def test_turns_make_a_rotation_go_the_long_way_and_a_loop_comes_back():
    maps = [rigid(0.0, 0j), rigid(1.0, 0j)]
    between = prepared(maps, turns=[1, 0], loop=True, anchor=0.5)
    fz = between.domain.anchor_fz(between.frame(0.5).fz)
    assert_allclose(fz, np.exp(0.5j * (1.0 + 2 * np.pi)), rtol=0, atol=1e-9)
    assert_allclose(between.at(2.0), MESH.vertices, rtol=0, atol=1e-9)


def test_consistent_angles_follow_a_bend_of_more_than_half_a_turn_where_principal_ones_fail():
    # Bent by 4.5 radians over its length, the bar's ends turn by more than π against its middle.
    maps = [bent(bar()), bent(bar(), bend=4.5 / 4, turn=2.0)]
    consistent = prepared(maps, anchor=0.0).frame(0.5)
    principal = prepared(maps, anchor=0.0, principal=True).frame(0.5)
    keep = np.abs(consistent.fz) - np.abs(consistent.fzbar)
    fold = np.abs(principal.fz) - np.abs(principal.fzbar)
    assert keep.min() > 0.5
    assert fold.min() < 0
    assert principal.poisson_error > 10 * consistent.poisson_error


def test_an_in_between_is_told_with_the_derivatives_of_its_triangles():
    frame = prepared(bent_pair()).frame(0.4)
    corners = MESH.triangles.T
    z, w = MESH.vertices[corners], frame.positions[corners]
    for k in (1, 2):
        dz, dw = z[k] - z[0], w[k] - w[0]
        assert_allclose(frame.fz * dz + frame.fzbar * dz.conj(), dw, rtol=0, atol=1e-12)
