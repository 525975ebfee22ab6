"""The scaling ρ of η: the pointwise rule of Section 7.3, and its smooth version."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from interpolation_shapes import bar, bent, boundary_of, letter_l, random_map
from numpy.testing import assert_allclose

from engine.geometry.polygon import edge_vectors
from engine.interpolation import TimeWeights, prepare
from engine.interpolation.scaling.exact_rho import BESIDE_KEY, ExactRho
from engine.interpolation.scaling.pointwise import PointSamples
from engine.interpolation.scaling.smoothed_rho import (
    FARTHEST,
    HALF_WINDOW,
    SmoothedRho,
    unstretch_times,
)
from engine.maps import Bounds, distortion
from engine.maps.harmonic_map import HarmonicMap
from engine.reference import Reference

SHAPE = letter_l()
STRAIGHT = TimeWeights.straight()


def pair(seed, shape=SHAPE, **options):
    return [random_map(shape, 2 * seed + i, **options) for i in range(2)]


def sharp_rho(maps, times, shape=SHAPE):
    return ExactRho.of(maps, shape[0], STRAIGHT, Bounds())(np.atleast_1d(times))


def smooth_rho(maps, shape=SHAPE):
    return SmoothedRho.of(ExactRho.of(maps, shape[0], STRAIGHT, Bounds()))


def grown(shape, k):
    """Return the identity and a map whose |f_z| grows along x, with the dilatation k everywhere."""
    _, cage = shape
    phi = 2 * np.exp(0.5 * cage + 1)
    return [HarmonicMap.identity(cage), HarmonicMap(cage=cage, phi=phi, psi=k * phi)]


def printed(maps, outline):
    """Return the paper's own formulas; they have no need of the anchor here."""
    return Reference(first=maps[0], second=maps[1], outline=outline, anchor=0j)


def dense_samples(shape, count=1000):
    outline, _ = shape
    return (outline[:, None] + edge_vectors(outline)[:, None] * np.arange(count) / count).ravel()


@given(seed=st.integers(0, 10_000), time=st.floats(BESIDE_KEY, 1 - BESIDE_KEY))
@settings(max_examples=5)
def test_rho_is_the_minimum_of_the_pointwise_ratios_over_the_outline(seed, time):
    maps = pair(seed)
    (rho,) = sharp_rho(maps, time)
    ratios = printed(maps, SHAPE[0]).allowed(dense_samples(SHAPE), time)
    sampled = min(1.0, ratios.min())
    assert rho <= sampled + 1e-9
    # The samples, 1000 an edge, miss a little of what happens close to the cage's vertices.
    assert_allclose(rho, sampled, rtol=0, atol=2e-3)


def test_no_valley_of_the_ratios_is_missed_however_many_there_are():
    # Sixteen like waves around a disc: the six lowest samples need not hold the lowest point.
    angle = 2 * np.pi * np.arange(64) / 64
    outline, cage = np.exp(1j * angle), 1.03 * np.exp(1j * angle)
    rng = np.random.default_rng(5)
    maps = [
        HarmonicMap(
            cage=cage,
            phi=cage + 0.02 * cage**17 / 17 * turn,
            psi=scale * (0.2 * cage + 0.1 * cage**17 / 17) + 1e-4 * rng.normal(size=64),
        )
        for turn, scale in ((1, 1), (-1j, 0.8))
    ]
    times = np.linspace(0.25, 0.75, 7)
    dense = dense_samples((outline, cage), 500)
    found = ExactRho.of(maps, outline, STRAIGHT, Bounds())(times)
    for time, rho in zip(times, found, strict=True):
        expected = printed(maps, outline).allowed(dense, time).min()
        assert rho <= min(1.0, expected) + 1e-9


def test_rho_of_affine_keyframes_follows_from_any_point():
    outline, cage = bar()
    rng = np.random.default_rng(1)
    for _ in range(8):
        fz = rng.uniform(0.5, 2, 2) * np.exp(1j * rng.uniform(-1, 1, 2))
        g = rng.uniform(0, 0.9, 2) * fz * np.exp(1j * rng.uniform(-3, 3, 2))
        maps = [
            HarmonicMap(cage=cage, phi=a * cage, psi=b * cage) for a, b in zip(fz, g, strict=True)
        ]
        times = np.array([0.25, 0.5, 0.75])
        for time, rho in zip(times, sharp_rho(maps, times, bar()), strict=True):
            ratios = printed(maps, outline).allowed(outline[:1], time)
            assert_allclose(rho, min(1.0, ratios.min()), rtol=3e-7, atol=0)


@pytest.mark.parametrize("bound", ["k", "sigma_a", "sigma_b"])
def test_each_bound_is_just_reached_where_it_alone_counts(bound):
    # |f_z| = 2 and |η| = 8 make the unscaled |f_z̄| = 4: far outside every bound.
    limits = {"k": 0.5, "sigma_a": 2.5, "sigma_b": 1.2}
    loose = {"k": 100.0, "sigma_a": 100.0, "sigma_b": -100.0}
    values = {name: np.array([v]) for name, v in (loose | {bound: limits[bound]}).items()}
    samples = PointSamples(
        log_modulus=np.log([[1.0], [4.0]]),
        conj_eta=np.array([[8.0 + 0j], [8.0]]),
        conformal=np.empty((0, 1), np.complex128),
        **values,
    )
    (rho,) = samples.largest_rhos(np.array([[0.5], [0.5]]))
    reached = {"k": rho * 4 / 2, "sigma_a": 2 + rho * 4, "sigma_b": 2 - rho * 4}
    assert_allclose(reached[bound], limits[bound], rtol=1e-12, atol=0)


def test_around_holes_no_smaller_rho_leaves_the_bounds_and_no_larger_one_obeys_them():
    rng = np.random.default_rng(3)
    count = 400
    a, b = rng.uniform(0.5, 2.0, count), rng.uniform(0.0, 0.8, count)
    d = rng.normal(0, 0.03, count) + 1j * rng.normal(0, 0.03, count)
    bounds = {"k": 0.45, "sigma_a": 2.3, "sigma_b": 0.35}
    samples = PointSamples(
        log_modulus=np.log(a)[None],
        conj_eta=(a * b + 0j)[None],
        conformal=d[None],
        **{name: np.full(count, bound) for name, bound in bounds.items()},
    )
    (ratios,) = samples.largest_rhos(np.ones((2, 1, 1)))
    assert 0.2 < (ratios < 1).mean() < 0.9

    def room(rho):
        fz, g = a * np.abs(rho + (1 - rho) * np.exp(d)), rho * b
        left = (bounds["k"] * fz - g, bounds["sigma_a"] - fz - g, fz - g - bounds["sigma_b"])
        return np.min(left, axis=0)

    largest = np.minimum(ratios, 1.0)
    reported = room(0 * a) > 0
    for share in np.linspace(0.0, 1.0, 33):
        assert (room(share * largest)[reported] > -1e-9).all()
    binding = reported & (ratios < 1)
    assert (room(1.001 * largest)[binding] < 0).all()


def test_rho_of_a_pair_that_can_be_worked_out():
    # From the identity k^t = t k |f_z|^(1 − 2t)..., largest where |f_z| is: at the right end.
    shape = bar()
    maps = grown(shape, 0.1)
    fz = np.abs(maps[1].derivatives(shape[0])[0])
    for time in (0.25, 0.4):
        blended = time * 0.1 * fz ** (2 - 2 * time)
        (rho,) = sharp_rho(maps, time, shape)
        assert_allclose(rho, (0.1 / blended).min(), rtol=1e-3, atol=0)


def test_conformal_keyframes_need_no_scaling():
    _, cage = SHAPE
    maps = [HarmonicMap.identity(cage), HarmonicMap(cage=cage, phi=5j * cage, psi=0 * cage)]
    assert smooth_rho(maps)(0.37) == 1.0


@pytest.mark.parametrize("seed", [25, 26, 27, 3, 11])
def test_the_smooth_rho_is_never_above_the_sharp_one_and_seldom_below(seed):
    sharp = ExactRho.of(pair(seed), SHAPE[0], STRAIGHT, Bounds())
    smooth = SmoothedRho.of(sharp)
    times = np.sort(
        np.concatenate([np.random.default_rng(0).random(300), 10.0 ** np.arange(-14, -1)])
    )
    highest, found = sharp(times), np.array([smooth(time) for time in times])
    assert highest.min() < 0.97
    assert np.all(found <= highest * (1 + 1e-6))  # which the sharp one leaves as a margin
    assert np.all(found >= 0.9 * highest)
    # Corners are cut within a small part of the time; everywhere else it is the sharp one.
    assert np.mean(found > highest * (1 - 2e-5)) > 0.6
    assert smooth.least <= found.min()


@pytest.mark.parametrize("seed", [26, 3])
def test_the_sharp_rho_is_looked_at_closely_at_its_kinks_only(seed):
    sharp = ExactRho.of(pair(seed), SHAPE[0], STRAIGHT, Bounds())
    asked = []

    def seen(times):
        asked.extend(times)
        return sharp(times)

    smooth = SmoothedRho.of(seen)
    samples = smooth.logarithms[HALF_WINDOW + 1 : -HALF_WINDOW - 1]
    everywhere = np.linspace(-FARTHEST, FARTHEST, len(samples))
    assert len(asked) < 0.4 * len(samples)
    assert_allclose(samples, np.log(sharp(unstretch_times(everywhere))), rtol=0, atol=5e-7)


def test_rho_does_not_fall_at_once_beside_a_key_where_the_other_part_vanishes():
    outline, cage = SHAPE
    (at_corner,) = HarmonicMap(cage=cage, phi=cage**2, psi=0 * cage).derivatives(outline[:1])[0]
    maps = [
        HarmonicMap(cage=cage, phi=cage, psi=0.05 * (cage**2 - at_corner * cage)),
        HarmonicMap(cage=cage, phi=1.3 * cage, psi=0.29 * cage),
    ]
    # f_z̄ of the first vanishes at a corner: its own bounds would scale η by a third from the start.
    for time in (1e-6, 1e-4, 1e-2):
        own = printed(maps, outline).allowed(outline[:1], time)
        assert own.min() < 0.75
    rho = smooth_rho(maps)
    assert rho(0.0) == rho(1.0) == 1.0
    times = np.linspace(0, 1, 200)
    found = np.array([rho(time) for time in times])
    assert found.min() < 0.8
    assert np.abs(np.diff(found)).max() < 0.05
    for time in (1e-12, 1e-9, 1e-6, 1e-4):
        assert_allclose([rho(time), rho(1 - time)], 1.0, rtol=0, atol=1e-3)


@pytest.mark.parametrize("seed", [25, 27])
def test_beside_a_key_the_bounds_are_the_worst_of_the_keyframes(seed):
    maps = pair(seed)
    dense = dense_samples(SHAPE, 500)
    between = prepare(maps, boundary_of(SHAPE), SHAPE[0], variant="scaled-eta")
    fz, fzbar = np.array([f.derivatives(dense) for f in maps]).transpose(1, 0, 2)
    for time in (0.003, 0.05, 0.15, 0.19, 0.93, 0.999):
        frame = between.frame(time)
        assert distortion.k(frame.fz, frame.fzbar).max() <= distortion.k(fz, fzbar).max() + 1e-6
        sigma_a, sigma_b = distortion.sigma_a(fz, fzbar), distortion.sigma_b(fz, fzbar)
        assert distortion.sigma_a(frame.fz, frame.fzbar).max() <= sigma_a.max() * (1 + 1e-6)
        assert distortion.sigma_b(frame.fz, frame.fzbar).min() >= sigma_b.min() * (1 - 1e-6)


@pytest.mark.parametrize("seed", [4, 42])
def test_the_worst_bounds_may_lie_on_either_side_of_a_sample(seed):
    # Looked for on one side alone they were too tight, and ρ below 0 where f_z̄ is small.
    maps = pair(seed)
    worst = ExactRho.of(maps, SHAPE[0], STRAIGHT, Bounds()).extremes
    points = dense_samples(SHAPE, 300)
    a, b = np.abs(np.array([f.derivatives(points) for f in maps]).swapaxes(0, 1))
    assert worst.k >= (b / a).max() - 1e-9
    assert worst.sigma_a >= (a + b).max() - 1e-9
    assert worst.sigma_b <= (a - b).min() + 1e-9


def test_maps_of_very_different_size_keep_their_bounds_beside_the_keys():
    _, cage = SHAPE
    maps = [
        HarmonicMap(cage=cage, phi=scale * f.phi, psi=scale * f.psi)
        for scale, f in zip((20.0, 0.05), pair(4), strict=True)
    ]
    smooth, sharp = smooth_rho(maps), ExactRho.of(maps, SHAPE[0], STRAIGHT, Bounds())
    times = np.sort(10.0 ** np.linspace(-9, -1, 60))
    assert np.all(np.array([smooth(time) for time in times]) <= sharp(times) * (1 + 1e-6))
    dense = dense_samples(SHAPE, 200)
    most = max(distortion.sigma_a(*f.derivatives(dense)).max() for f in maps)
    least = min(distortion.sigma_b(*f.derivatives(dense)).min() for f in maps)
    between = prepare(maps, boundary_of(SHAPE), SHAPE[0], variant="scaled-eta")
    for time in (1e-6, 1e-3, 0.1, 0.5, 0.9, 1 - 1e-3, 1 - 1e-6):
        frame = between.frame(time)
        assert distortion.sigma_a(frame.fz, frame.fzbar).max() <= most * (1 + 1e-6)
        assert distortion.sigma_b(frame.fz, frame.fzbar).min() >= least * (1 - 1e-6)


def test_the_smooth_rho_has_no_kinks():
    maps = grown(bar(), 0.3)
    sharp = ExactRho.of(maps, bar()[0], STRAIGHT, Bounds())
    smooth = SmoothedRho.of(sharp)
    # Second differences of a smooth function fall by 4 when the step is halved; at a kink by 2.
    falls = []
    for rho, count in (
        (sharp, 1000),
        (lambda times: np.array([smooth(time) for time in times]), 8_000),
    ):
        largest = [
            np.abs(np.diff(rho(np.arange(0.05, 0.95, 1 / n)), 2)).max() for n in (count, 2 * count)
        ]
        falls.append(largest[0] / largest[1])
    assert falls[0] < 2.8
    assert falls[1] > 3.5


def test_a_rigid_motion_of_a_keyframe_does_not_change_rho():
    maps = pair(6)
    moved = [maps[0], bent(SHAPE, turn=0.7, shift=3)]
    turned = [HarmonicMap(cage=f.cage, phi=1j * f.phi, psi=f.psi / 1j) for f in (maps[0], moved[1])]
    times = np.array([0.1, 0.5, 0.8])
    assert_allclose(
        [smooth_rho([maps[0], moved[1]])(t) for t in times],
        [smooth_rho(turned)(t) for t in times],
        rtol=1e-9,
        atol=0,
    )
