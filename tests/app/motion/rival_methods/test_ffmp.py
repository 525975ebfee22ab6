"""Free-form motion processing: facts of Kircher and Garland (2008)."""

import numpy as np
from hypothesis import given, settings, strategies as st
from meshed_shapes import meshed_bar, stretched_pair
from numpy.testing import assert_allclose

from app.motion import prepare_baseline

MESH = meshed_bar()


def in_between(positions, time=0.4):
    return prepare_baseline("ffmp", positions, MESH.vertices, MESH.triangles).frame(time)


@given(seed=st.integers(0, 10_000))
@settings(max_examples=4)
def test_affine_maps_of_the_keyframes_make_an_affine_map_of_the_in_between(seed):
    rng = np.random.default_rng(seed)
    positions = [f(MESH.vertices) for f in stretched_pair()]
    moved = []
    for each in positions:
        a = np.exp(1j * rng.uniform(-3, 3)) * rng.uniform(0.5, 2)
        b = 0.7 * abs(a) * np.exp(1j * rng.uniform(-3, 3)) * rng.uniform()
        moved.append(a * each + b * each.conj() + complex(*rng.normal(size=2)))
    before, after = in_between(positions).positions, in_between(moved).positions
    affine = np.column_stack([np.ones(len(before)), before, before.conj()])
    fitted = affine @ np.linalg.lstsq(affine, after, rcond=None)[0]
    assert_allclose(after, fitted, rtol=0, atol=1e-9)


def test_arap_is_not_invariant_to_affine_maps():
    positions = [f(MESH.vertices) for f in stretched_pair()]
    moved = [z + 0.5 * z.conj() for z in positions]
    before, after = (
        prepare_baseline("arap", each, MESH.vertices, MESH.triangles).frame(0.4).positions
        for each in (positions, moved)
    )
    affine = np.column_stack([np.ones(len(before)), before, before.conj()])
    fitted = affine @ np.linalg.lstsq(affine, after, rcond=None)[0]
    assert np.abs(after - fitted).max() > 0.02


def test_only_an_affine_map_apart_keyframes_have_in_betweens_that_fit_all_ratios():
    first = stretched_pair()[1](MESH.vertices)
    frame = in_between([first, 1.5j * first + 0.3 * first.conj()])
    assert frame.poisson_error < 1e-11
