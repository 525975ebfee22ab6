"""The paper's Properties 1 to 8, for exactly the variants that claim them."""

import numpy as np
import pytest
from deform_shapes import STAR_POINTS, star, star_boundary
from hypothesis import given, settings, strategies as st
from interpolation_shapes import (
    bar,
    bent,
    distortion_of,
    inner_points,
    letter_l,
    narrow_u,
    outline_samples,
    random_map,
    scattered_on,
    stage_of,
)
from numpy.testing import assert_allclose

from engine.interpolation import Variant, prepare
from engine.interpolation.scaling.exact_rho import BESIDE_KEY
from engine.maps import distortion
from engine.maps.harmonic_map import HarmonicMap

INTEGRATED = (Variant.NU, Variant.ETA, Variant.SCALED_ETA, Variant.METRIC)
BOUNDED = (Variant.SCALED_ETA, Variant.METRIC)
MIDDLE = st.floats(BESIDE_KEY, 1 - BESIDE_KEY)
ALL = tuple(Variant)
SHAPES = {"bar": bar(), "letter L": letter_l(), "narrow U": narrow_u(0.1)}


def pair(name, seed):
    return [random_map(SHAPES[name], 2 * seed + i) for i in range(2)]


def prepared(name, maps, variant, points, anchor=None):
    return stage_of(SHAPES[name], points, anchor).between(maps, variant)


def limits(maps, points):
    """Return the keyframes' largest sigma_a, smallest sigma_b and largest k at each point."""
    a, b, k = np.array([distortion_of(f, points) for f in maps]).transpose(1, 0, 2)
    return a.max(axis=0), b.min(axis=0), k.max(axis=0)


def distortions(frame):
    a, b = np.abs(frame.fz), np.abs(frame.fzbar)
    return a + b, a - b, b / a


cases = st.tuples(st.sampled_from(sorted(SHAPES)), st.integers(0, 10_000))
times = st.floats(0.01, 0.99)


@pytest.mark.parametrize("variant", ALL)
@given(case=cases)
@settings(max_examples=4)
def test_property_1_keyframes_are_reproduced_without_a_jump(variant, case):
    name, seed = case
    maps = pair(name, seed)
    points = np.concatenate([inner_points(SHAPES[name][0], 40, 1), SHAPES[name][0]])
    between = prepared(name, maps, variant, points)
    size = between.sampled_domain.diameter
    for time, f in enumerate(maps):
        frame = between.frame(time)
        fz, fzbar = f.derivatives(points)
        assert_allclose(frame.positions, f(points), rtol=0, atol=1e-11 * size)
        assert_allclose(frame.fz, fz, rtol=1e-11, atol=0)
        assert_allclose(frame.fzbar, fzbar, rtol=0, atol=1e-11)
        beside = between.frame(abs(time - 1e-13))
        assert_allclose(beside.positions, frame.positions, rtol=0, atol=1e-6 * size)


@pytest.mark.parametrize("variant", INTEGRATED)
@given(case=cases, time=times)
@settings(max_examples=6)
def test_property_2_in_betweens_are_harmonic_with_the_derivatives_they_tell(variant, case, time):
    name, seed = case
    middle = inner_points(SHAPES[name][0], 12, 1, margin=0.12)
    h = 0.01
    stencil = h * np.array([0, 1, -1, 1j, -1j, 2, -2, 2j, -2j])
    points = (middle[:, None] + stencil).ravel()
    frame = prepared(name, pair(name, seed), variant, points).frame(time)
    f = frame.positions.reshape(-1, 9)
    scale = np.abs(frame.fz).max()
    by_x = (8 * (f[:, 1] - f[:, 2]) - (f[:, 5] - f[:, 6])) / (12 * h)
    by_y = (8 * (f[:, 3] - f[:, 4]) - (f[:, 7] - f[:, 8])) / (12 * h)
    assert_allclose((by_x - 1j * by_y) / 2, frame.fz[::9], rtol=0, atol=2e-4 * scale)
    assert_allclose((by_x + 1j * by_y) / 2, frame.fzbar[::9], rtol=0, atol=2e-4 * scale)
    laplacian = f[:, 1:5].sum(axis=1) - 4 * f[:, 0]
    assert_allclose(laplacian, 0, rtol=0, atol=2e-5 * scale * h)


@pytest.mark.parametrize("variant", [Variant.NU, Variant.SCALED_ETA, Variant.METRIC])
@given(case=cases, time=times)
@settings(max_examples=5)
def test_property_3_no_in_between_folds(variant, case, time):
    name, seed = case
    along = scattered_on(SHAPES[name][0], 12)
    inside = inner_points(SHAPES[name][0], 50, 1)
    frame = prepared(name, pair(name, seed), variant, np.concatenate([along, inside])).frame(time)
    fz, g = frame.fz[: len(along)], frame.fzbar[: len(along)].conj()
    _, sigma_b, k = distortions(frame)
    assert sigma_b.min() > 0
    assert k.max() < 1
    # f_z and conj(f_z̄) are holomorphic: if f_z does not wind around 0 along the outline and k is
    # below 1 there, k is below 1 everywhere inside, and f_z has no zero.
    turns = np.angle(np.roll(fz, -1) / fz)
    assert np.abs(turns).max() < 1
    assert round(turns.sum() / (2 * np.pi)) == 0
    # Between neighbouring points both change by far less than what is left of the bound.
    change = np.abs(np.roll(g / fz, -1) - g / fz)
    assert np.all(np.abs(g / fz) + 2 * change < 1 + 1e-9)


@pytest.mark.parametrize("seed", [0, 4, 9])
@pytest.mark.parametrize("variant", [Variant.NU, Variant.ETA, Variant.METRIC])
def test_property_4_in_betweens_are_smooth_in_time(variant, seed):
    name = "letter L"
    points = inner_points(SHAPES[name][0], 20, 3)
    between = prepared(
        name, [random_map(SHAPES[name], 10 * seed + i, k=0.4) for i in (4, 5)], variant, points
    )
    # The coefficients of a smooth function's Chebyshev series die away faster than any power.
    x = np.cos(np.pi * np.arange(65) / 64)
    f = np.array([between.frame((1 + t) / 2).positions for t in x])
    coefficients = np.abs(np.linalg.solve(np.polynomial.chebyshev.chebvander(x, 64), f))
    assert coefficients[28:36].max() < 1e-5 * coefficients.max()
    assert coefficients[58:].max() < 1e-8 * coefficients.max()


@pytest.mark.parametrize("seed", [25, 27, 3])
def test_property_4_scaled_eta_moves_smoothly_through_the_whole_interval(seed):
    name = "letter L"
    points = inner_points(SHAPES[name][0], 20, 3)
    between = prepared(name, pair(name, seed), "scaled-eta", points)

    def bend(time, step):
        before, at, after = (between.frame(time + k * step).positions for k in (-1, 0, 1))
        return np.abs(after - 2 * at + before).max()

    # A quarter of the step, a sixteenth of the second difference, wherever that is.
    for time in (0.05, 0.2, 0.37, 0.5, 0.81, 0.95):
        assert bend(time, 5e-5) < bend(time, 2e-4) / 10 + 1e-10
    # And no jump at the keys.
    for key in (0.0, 1.0):
        beside = between.frame(abs(key - 1e-6)).positions
        assert_allclose(beside, between.frame(key).positions, rtol=0, atol=1e-4)


@given(case=cases, time=times)
@settings(max_examples=12)
def test_nu_keeps_properties_5_and_7_at_every_point(case, time):
    name, seed = case
    maps = pair(name, seed)
    points = np.concatenate([outline_samples(SHAPES[name]), inner_points(SHAPES[name][0], 200, 1)])
    sigma_a, sigma_b, k = distortions(prepared(name, maps, "nu", points).frame(time))
    _, least_b, most_k = limits(maps, points)
    assert np.all(k <= most_k * (1 + 1e-9))
    assert np.all(sigma_b >= least_b * (1 - 1e-9))
    # Of Property 6 only this is true: σ_a = (1 + k) |f_z|, and both factors are bounded.
    most_fz = np.max([np.abs(f.derivatives(points)[0]) for f in maps], axis=0)
    assert np.all(sigma_a <= (1 + most_k) * most_fz * (1 + 1e-9))


def test_nu_can_break_property_6():
    _, cage = SHAPES["bar"]
    maps = [HarmonicMap.identity(cage), HarmonicMap(cage=cage, phi=2 * cage / 3, psi=cage / 3)]
    frame = prepared("bar", maps, "nu", np.array([0.1 + 0.1j])).frame(0.466)
    assert_allclose(distortions(frame)[0], 1.0207, rtol=0, atol=1e-4)


@given(case=cases, time=MIDDLE)
@settings(max_examples=6)
def test_scaled_eta_keeps_properties_5_to_7_on_the_outline_away_from_the_keys(case, time):
    name, seed = case
    maps = pair(name, seed)
    outline = scattered_on(SHAPES[name][0], 40)
    frame = prepared(name, maps, "scaled-eta", outline).frame(time)
    for values, limit, sign in zip(
        distortions(frame), limits(maps, outline), (1, -1, 1), strict=True
    ):
        assert np.all(sign * values <= sign * limit + 1e-7 * np.abs(limit).max())
    assert 0 < frame.rho <= 1


@given(case=cases, time=times)
@settings(max_examples=6)
def test_scaled_eta_keeps_properties_5_to_7_globally_at_all_times(case, time):
    name, seed = case
    maps = pair(name, seed)
    outline = scattered_on(SHAPES[name][0], 60)
    inside = inner_points(SHAPES[name][0], 200, 1)
    frame = prepared(name, maps, "scaled-eta", np.concatenate([outline, inside])).frame(time)
    dense = np.concatenate([outline, outline_samples(SHAPES[name])])
    for values, limit, sign in zip(
        distortions(frame), limits(maps, dense), (1, -1, 1), strict=True
    ):
        # The worst of the outline is between the samples, by a part of a thousand.
        assert np.all(sign * values <= (sign * limit).max() + 1e-3 * np.abs(limit).max())


@given(case=cases, time=times)
@settings(max_examples=6)
def test_metric_keeps_properties_5_to_7_globally(case, time):
    name, seed = case
    maps = pair(name, seed)
    outline = scattered_on(SHAPES[name][0], 30)
    inside = inner_points(SHAPES[name][0], 200, 1)
    frame = prepared(name, maps, "metric", np.concatenate([outline, inside])).frame(time)
    for values, limit, sign in zip(
        distortions(frame), limits(maps, outline), (1, -1, 1), strict=True
    ):
        scale = np.abs(limit).max()
        # On the outline the blended metric itself is bounded, point by point.
        assert np.all(sign * values[: len(outline)] <= sign * limit + 1e-5 * scale)
        assert np.all(sign * values <= (sign * limit).max() + 1e-3 * scale)


@given(seed=st.integers(0, 10_000), time=st.floats(0, 3))
@settings(max_examples=2)
def test_properties_5_to_8_hold_in_every_interval_of_four_keyframes(seed, time):
    name = "letter L"
    maps = [random_map(SHAPES[name], 4 * seed + i, k=0.4) for i in range(4)]
    outline = scattered_on(SHAPES[name][0], 20)
    first = min(int(time), 2)
    around = maps[first : first + 2]
    mu0, mu1 = (distortion.mu(*f.derivatives(outline)) for f in around)
    for variant in BOUNDED:
        options = {"variant": variant}
        if variant.needs_transform:
            options["transform"] = stage_of(SHAPES[name], outline).transform
        boundary = stage_of(SHAPES[name], outline).sites.boundary
        frame = prepare(maps, boundary, outline, **options).frame(time)
        for values, limit, sign in zip(
            distortions(frame), limits(around, outline), (1, -1, 1), strict=True
        ):
            worst = (sign * limit).max()
            assert np.all(sign * values <= worst + 2e-3 * np.abs(limit).max())
        mu = distortion.mu(frame.fz, frame.fzbar)
        clear = (np.abs(mu) > 1e-6) & (np.abs(mu0) > 1e-6) & (np.abs(mu1) > 1e-6)
        way = np.abs(np.angle(mu / mu0)) + np.abs(np.angle(mu1 / mu))
        assert_allclose(way[clear], np.abs(np.angle(mu1 / mu0))[clear], rtol=0, atol=1e-8)


@pytest.mark.parametrize("variant", [Variant.NU, *BOUNDED])
def test_keyframes_that_hardly_do_not_fold_have_in_betweens_that_do_not(variant):
    name = "bar"
    _, cage = SHAPES[name]
    # k = 0.9995 everywhere, in directions that differ by a right angle of stretch.
    maps = [
        HarmonicMap(cage=cage, phi=cage, psi=0.9995 * cage),
        HarmonicMap(cage=cage, phi=np.exp(0.8j) * cage, psi=-0.9995 * np.exp(-0.8j) * cage),
    ]
    points = np.concatenate([inner_points(SHAPES[name][0], 60, 0), SHAPES[name][0]])
    between = prepared(name, maps, variant, points)
    for time in (1e-6, 0.01, 0.3, 0.5, 0.9):
        sigma_a, sigma_b, k = distortions(between.frame(time))
        assert np.all(k <= 0.9995 + 1e-9)
        assert np.all(sigma_b >= 0.0005 * (1 - 1e-5))
        assert np.all(sigma_a <= 1.9995 * (1 + 1e-5))


def test_metric_blends_the_metric_tensor_linearly_on_the_outline():
    maps = pair("letter L", 7)
    points = outline_samples(SHAPES["letter L"])
    frame = prepared("letter L", maps, "metric", points).frame(0.3)

    def metric(fz, fzbar):
        return np.abs(fz) ** 2 + np.abs(fzbar) ** 2, distortion.eta(fz, fzbar)

    trace0, eta0 = metric(*maps[0].derivatives(points))
    trace1, eta1 = metric(*maps[1].derivatives(points))
    trace, eta = metric(frame.fz, frame.fzbar)
    assert_allclose(trace, 0.7 * trace0 + 0.3 * trace1, rtol=1e-5, atol=0)
    assert_allclose(eta, 0.7 * eta0 + 0.3 * eta1, rtol=0, atol=1e-12 * np.abs(eta0).max())


@pytest.mark.parametrize("variant", [Variant.ETA, Variant.SCALED_ETA, Variant.METRIC])
@given(case=cases, time=times)
@settings(max_examples=6)
def test_property_8_the_stretch_direction_takes_the_shorter_way(variant, case, time):
    name, seed = case
    maps = pair(name, seed)
    points = inner_points(SHAPES[name][0], 100, 1)
    frame = prepared(name, maps, variant, points).frame(time)
    mu0, mu1 = (distortion.mu(*f.derivatives(points)) for f in maps)
    mu = distortion.mu(frame.fz, frame.fzbar)
    way = np.abs(np.angle(mu / mu0)) + np.abs(np.angle(mu1 / mu))
    clear = np.abs(mu) > 1e-6
    assert_allclose(way[clear], np.abs(np.angle(mu1 / mu0))[clear], rtol=0, atol=1e-9)


@pytest.mark.parametrize("variant", [Variant.ETA, Variant.SCALED_ETA, Variant.METRIC])
def test_property_8_beside_a_conformal_keyframe(variant):
    conformal = bent(SHAPES["bar"], bend=0.6)
    other = random_map(SHAPES["bar"], 3)
    points = inner_points(SHAPES["bar"][0], 60, 0)
    frame = prepared("bar", [conformal, other], variant, points).frame(0.4)
    mu1 = distortion.mu(*other.derivatives(points))
    turn = np.angle(distortion.mu(frame.fz, frame.fzbar) / mu1)
    assert_allclose(turn, 0, rtol=0, atol=1e-9)


@pytest.mark.parametrize("variant", INTEGRATED)
def test_conformal_keyframes_have_conformal_in_betweens(variant):
    maps = [bent(SHAPES["bar"], bend=0.5), bent(SHAPES["bar"], bend=-0.7, turn=2.0)]
    frame = prepared("bar", maps, variant, inner_points(SHAPES["bar"][0], 40, 0)).frame(0.6)
    assert_allclose(frame.fzbar, 0, rtol=0, atol=1e-12)


def test_stretch_direction_as_in_figure_3():
    # Both keyframes stretch along y by 2 (μ = −1/3); the second turns by 90 degrees besides.
    _, cage = SHAPES["bar"]
    maps = [
        HarmonicMap(cage=cage, phi=turn * 1.5 * cage, psi=-np.conj(turn) * 0.5 * cage)
        for turn in (1, 1j)
    ]
    points = inner_points(SHAPES["bar"][0], 5, 0)
    directions = {
        variant: 0.5 * np.angle(distortion.mu(frame.fz, frame.fzbar))
        for variant in INTEGRATED
        for frame in [prepared("bar", maps, variant, points).frame(0.8)]
    }
    for variant in (Variant.ETA, Variant.SCALED_ETA, Variant.METRIC):
        assert_allclose(np.abs(directions[variant]), np.pi / 2, rtol=0, atol=1e-9)
    assert np.all(np.abs(np.abs(directions[Variant.NU]) - np.pi / 2) > 0.05)


def test_unscaled_eta_leaves_its_bounds_and_scaling_brings_it_back_as_in_figure_4():
    # |f_z| grows by more than the root of e towards the right end of the bar.
    _, cage = SHAPES["bar"]
    grown = 2 * np.exp(0.5 * cage + 1)
    maps = [HarmonicMap.identity(cage), HarmonicMap(cage=cage, phi=grown, psi=0.4 * grown)]
    points = outline_samples(SHAPES["bar"])
    most_k = limits(maps, points)[2]
    sharp, unscaled = (
        [prepared("bar", maps, variant, points).frame(t) for t in (0.25, 0.5, 0.75)]
        for variant in ("scaled-eta", "eta")
    )
    assert all((distortions(frame)[2] <= most_k + 1e-9).all() for frame in sharp)
    assert max((distortions(frame)[2] - most_k).max() for frame in unscaled) > 0.05
    assert all(frame.rho < 0.9 for frame in sharp)


@pytest.mark.parametrize("variant", INTEGRATED)
def test_rigid_motions_are_interpolated_as_rotations(variant):
    maps = [bent(SHAPES["bar"]), bent(SHAPES["bar"], turn=2.5, shift=3 + 1j)]
    points = inner_points(SHAPES["bar"][0], 30, 0)
    frame = prepared("bar", maps, variant, points, anchor=0.5).frame(0.3)
    expected = 0.5 + 0.3 * (maps[1](np.array([0.5 + 0j])) - 0.5)
    assert_allclose(frame.positions, expected + np.exp(0.75j) * (points - 0.5), rtol=0, atol=1e-10)


@pytest.mark.parametrize("variant", INTEGRATED)
@given(seed=st.integers(0, 10_000))
@settings(max_examples=4)
def test_a_motion_of_all_keyframes_moves_the_in_betweens(variant, seed):
    maps = pair("letter L", seed)
    points = inner_points(SHAPES["letter L"][0], 30, 1)
    rotation, shift = np.exp(1.1j), 2 - 3j
    moved = [
        HarmonicMap(cage=f.cage, phi=rotation * f.phi + shift, psi=f.psi / rotation) for f in maps
    ]
    frame, after = (prepared("letter L", m, variant, points).frame(0.4) for m in (maps, moved))
    assert_allclose(after.positions, rotation * frame.positions + shift, rtol=0, atol=1e-9)


@pytest.mark.parametrize("variant", [Variant.ETA, Variant.METRIC])
def test_the_anchor_moves_eta_and_metric_only_rigidly(variant):
    maps = pair("letter L", 11)
    points = inner_points(SHAPES["letter L"][0], 80, 0)
    first, second = (
        prepared("letter L", maps, variant, points, anchor=anchor).frame(0.5)
        for anchor in (0.5 + 0.5j, 2.5 + 0.5j)
    )
    turn = second.fz[0] / first.fz[0]
    assert_allclose(np.abs(turn), 1, rtol=1e-6, atol=0)
    assert_allclose(second.fz, turn * first.fz, rtol=1e-5, atol=0)
    difference = second.positions - turn * first.positions
    assert_allclose(difference, difference[0], rtol=0, atol=1e-5)


@given(seed=st.integers(0, 10_000), time=times)
@settings(max_examples=3)
def test_in_betweens_of_dragged_and_certified_keyframes_keep_their_bounds(seed, time):
    deformer = star()
    rng = np.random.default_rng(seed)
    state, maps, proven = deformer.start(), [], []
    for _ in range(2):
        targets = np.exp(1j * rng.uniform(-1, 1)) * STAR_POINTS
        targets += 0.4 * (rng.normal(size=len(targets)) + 1j * rng.normal(size=len(targets)))
        for _ in range(15):
            state = deformer.step(state, deformer.handles.targets(targets))
        assert state.certificate.is_certified
        maps.append(state.map)
        proven.append(state.certificate)
    boundary = star_boundary()
    points = np.concatenate([boundary.points, inner_points(boundary.outline, 50, 1)])
    stage = stage_of((boundary.outline, boundary.cage), points)
    most_a, least_b, most_k = (
        max(c.sigma_a for c in proven),
        min(c.sigma_b for c in proven),
        max(c.k for c in proven),
    )
    for variant in (Variant.NU, Variant.SCALED_ETA, Variant.METRIC):
        frame = stage.between(maps, variant).frame(time)
        sigma_a, sigma_b, k = distortions(frame)
        assert k.max() <= most_k + 1e-5
        assert sigma_b.min() >= least_b - 1e-5
        assert variant == Variant.NU or sigma_a.max() <= most_a + 1e-5
