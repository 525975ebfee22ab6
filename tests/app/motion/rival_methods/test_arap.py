"""As-rigid-as-possible interpolation: facts of Alexa, Cohen-Or and Levin (2000)."""

import numpy as np
from interpolation_shapes import bar, bent
from meshed_shapes import meshed_bar, rigid
from numpy.testing import assert_allclose

from app.motion import prepare_baseline

MESH = meshed_bar()


def prepared(maps, **options):
    return prepare_baseline("arap", maps, MESH.vertices, MESH.triangles, **options)


def test_turns_make_a_rotation_go_the_long_way_and_a_loop_comes_back():
    maps = [rigid(0.0, 0j), rigid(1.0, 0j)]
    between = prepared(maps, turns=[1, 0], loop=True, anchor=0.5)
    fz = between.domain.anchor_fz(between.frame(0.5).fz)
    assert_allclose(fz, np.exp(0.5j * (1.0 + 2 * np.pi)), rtol=0, atol=1e-9)
    assert_allclose(between.frame(2.0).positions, MESH.vertices, rtol=0, atol=1e-9)


def test_consistent_angles_follow_a_bend_of_more_than_half_a_turn_where_principal_ones_fail():
    # Bent by 4.5 radians over its length, the bar's ends turn by more than π against its middle.
    maps = [bent(bar(0.25)), bent(bar(0.25), bend=4.5 / 4, turn=2.0)]
    consistent = prepared(maps, anchor=0.0).frame(0.5)
    principal = prepared(maps, anchor=0.0, principal=True).frame(0.5)
    keep = np.abs(consistent.fz) - np.abs(consistent.fzbar)
    fold = np.abs(principal.fz) - np.abs(principal.fzbar)
    assert keep.min() > 0.5
    assert fold.min() < 0
    assert principal.poisson_error > 10 * consistent.poisson_error
