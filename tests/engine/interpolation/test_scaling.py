"""The scaling ρ of η: the pointwise rule, the smooth version, spline weights."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from interpolation_shapes import (
    bar,
    inner_points,
    letter_l,
    outline_samples,
    random_map,
)
from numpy.testing import assert_allclose

from engine.geometry.polygon import edges
from engine.interpolation import prepare
from engine.interpolation.scaling import PointSamples
from engine.maps.harmonic_map import HarmonicMap

SHAPE = letter_l()
POINTS = np.array([0.5 + 0.5j])


def rho_of(maps, shape=SHAPE, **options):
    between = prepare(maps, POINTS, outline=shape[0], variant="scaled-eta", **options)
    return lambda time: between.frame(time).rho


def grown(shape, k):
    """Return the identity and a map whose |f_z| grows along x, with the dilatation k everywhere."""
    _, cage = shape
    phi = 2 * np.exp(0.5 * cage + 1)
    return [HarmonicMap.identity(cage), HarmonicMap(cage=cage, phi=phi, psi=k * phi)]


def ratios_by_the_book(maps, weights, points):
    """Return ρ_k, ρ_a and ρ_b of Section 7.3 at points (3, p), written as they are printed."""
    fz, fzbar = np.array([f.derivatives(points) for f in maps]).transpose(1, 0, 2)
    a, b = np.abs(fz), np.abs(fzbar)
    modulus = np.prod(a ** weights[:, None], axis=0)
    eta = np.abs((weights[:, None] * fz * fzbar.conj()).sum(axis=0))
    other = eta / modulus
    rho_k = (b / a).max(axis=0) / (other / modulus)
    rho_a = ((a + b).max(axis=0) - modulus) / other
    rho_b = (modulus - (a - b).min(axis=0)) / other
    return np.array([rho_k, rho_a, rho_b])


@given(seed=st.integers(0, 10_000), time=st.floats(0.02, 0.98))
@settings(max_examples=8)
def test_rho_is_the_minimum_of_the_pointwise_ratios_over_the_outline(seed, time):
    maps = [random_map(SHAPE, 2 * seed + i) for i in range(2)]
    weights = np.array([1 - time, time])
    outline, _ = SHAPE
    dense = (outline[:, None] + edges(outline)[:, None] * np.arange(4000) / 4000).ravel()
    rho = rho_of(maps)(time)
    sampled = min(1.0, ratios_by_the_book(maps, weights, dense).min())
    assert rho <= sampled + 1e-9
    # The samples, 4000 an edge, miss a little of what happens close to the cage's vertices.
    assert_allclose(rho, sampled, rtol=0, atol=1e-4)


def test_rho_of_affine_keyframes_follows_from_any_point():
    outline, cage = bar()
    rng = np.random.default_rng(1)
    for _ in range(8):
        fz = rng.uniform(0.5, 2, 2) * np.exp(1j * rng.uniform(-1, 1, 2))
        g = rng.uniform(0, 0.9, 2) * fz * np.exp(1j * rng.uniform(-3, 3, 2))
        maps = [
            HarmonicMap(cage=cage, phi=a * cage, psi=b * cage) for a, b in zip(fz, g, strict=True)
        ]
        rho = rho_of(maps, bar())
        for time in (0.25, 0.5, 0.75):
            ratios = ratios_by_the_book(maps, np.array([1 - time, time]), outline[:1])
            assert_allclose(rho(time), min(1.0, ratios.min()), rtol=1e-9, atol=0)


@pytest.mark.parametrize("bound", ["k", "sigma_a", "sigma_b"])
def test_each_bound_is_just_reached_where_it_alone_counts(bound):
    # |f_z| = 2 and |η| = 8 make the unscaled |f_z̄| = 4: far outside every bound.
    limits = {"k": 0.5, "sigma_a": 2.5, "sigma_b": 1.2}
    loose = {"k": 100.0, "sigma_a": 100.0, "sigma_b": -100.0}
    values = {name: np.array([v]) for name, v in (loose | {bound: limits[bound]}).items()}
    samples = PointSamples(
        log_modulus=np.log([[1.0], [4.0]]), conj_eta=np.array([[8.0 + 0j], [8.0]]), **values
    )
    (rho,) = samples.ratios(np.array([0.5, 0.5]))
    reached = {"k": rho * 4 / 2, "sigma_a": 2 + rho * 4, "sigma_b": 2 - rho * 4}
    assert_allclose(reached[bound], limits[bound], rtol=1e-12, atol=0)


def test_rho_of_a_pair_that_can_be_worked_out():
    # From the identity k^t = t k |f_z|^(1 − 2t)..., largest where |f_z| is: at the right end.
    shape = bar()
    maps = grown(shape, 0.1)
    fz = np.abs(maps[1].derivatives(shape[0])[0])
    for time in (0.2, 0.4):
        blended = time * 0.1 * fz ** (2 - 2 * time)
        assert_allclose(rho_of(maps, shape)(time), (0.1 / blended).min(), rtol=1e-3, atol=0)


@pytest.mark.parametrize("smooth_rho", [False, True])
def test_rho_is_one_at_keyframes_and_continuous_there(smooth_rho):
    rho = rho_of([random_map(SHAPE, seed) for seed in (3, 6, 8)], smooth_rho=smooth_rho)
    for key in (0.0, 1.0, 2.0):
        assert rho(key) == 1.0
        for beside in (max(key - 1e-10, 0.0), min(key + 1e-10, 2.0)):
            assert_allclose(rho(beside), 1.0, rtol=0, atol=1e-5)


def test_conformal_keyframes_need_no_scaling():
    _, cage = SHAPE
    maps = [HarmonicMap.identity(cage), HarmonicMap(cage=cage, phi=5j * cage, psi=0 * cage)]
    assert rho_of(maps)(0.37) == 1.0


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_smooth_rho_is_never_above_the_sharp_one(seed):
    maps = [random_map(SHAPE, 50 + 2 * seed + i) for i in range(2)]
    sharp, smooth = rho_of(maps), rho_of(maps, smooth_rho=True)
    times = np.concatenate([np.linspace(0.001, 0.999, 150), 10.0 ** np.arange(-14, -3)])
    values = np.array([(sharp(t), smooth(t)) for t in times])
    assert values[:150, 0].min() < 0.97
    assert np.all(values[:, 1] <= values[:, 0] + 1e-9)
    assert np.all(values[:, 1] > 0.3 * values[:, 0])


def test_the_smooth_rho_has_no_kinks():
    maps = grown(bar(), 0.3)
    # Second differences of a smooth function fall by 4 when the step is halved; at a kink by 2.
    falls = []
    for smooth_rho, count in ((False, 200), (True, 4000)):
        rho = rho_of(maps, bar(), smooth_rho=smooth_rho)
        largest = [
            np.abs(np.diff([rho(t) for t in np.arange(0.05, 0.95, 1 / n)], 2)).max()
            for n in (count, 2 * count)
        ]
        falls.append(largest[0] / largest[1])
    assert falls[0] < 2.8
    assert falls[1] > 3.5


def test_spline_weights_are_scaled_against_all_keyframes():
    maps = [random_map(SHAPE, seed, bend=0.3, k=0.3) for seed in (1, 4, 9)]
    points = np.concatenate([outline_samples(SHAPE), inner_points(SHAPE[0], 20, 0)])
    between = prepare(maps, points, outline=SHAPE[0], variant="scaled-eta", easing=None)
    most = np.max(
        [np.abs(g) / np.abs(fz) for fz, g in (f.derivatives(points) for f in maps)], axis=0
    )
    for time in (0.4, 1.3):
        frame = between.frame(time)
        if frame.rho > 0:
            assert np.all(np.abs(frame.fzbar) <= np.abs(frame.fz) * most + 1e-9)
    for key, f in enumerate(maps):
        assert_allclose(between.frame(key).positions, f(points), rtol=0, atol=1e-10)
