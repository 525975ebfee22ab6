"""In-betweens are proven: nothing at any time is beyond an enclosure, and enclosures are tight."""

import numpy as np
import pytest
from holed_shapes import plate, random_map as holed_map
from hypothesis import given, settings, strategies as st
from interpolation_shapes import (
    bar,
    boundary_of,
    inner_points,
    letter_l,
    random_map,
    scattered_on,
    stage_of,
)
from messages import says

from engine.errors import EngineError
from engine.geometry import Domain
from engine.interpolation import InteriorKnot, Tangent, TimeWeights, Variant, prepare
from engine.interpolation.added.pins.pinning import CorrectionSeries
from engine.interpolation.blends.eta import EtaBlend
from engine.interpolation.blends.linear import LinearBlend
from engine.interpolation.blends.metric import MetricBlend
from engine.interpolation.blends.nu import NuBlend
from engine.interpolation.enclosures.cells import BernsteinPatch, BlendChanges
from engine.interpolation.enclosures.pieces import Subdivision
from engine.interpolation.proof import bisection
from engine.interpolation.proof.bisection import TIGHTNESS, prove
from engine.interpolation.sampled_domain import NO_SAMPLES
from engine.interpolation.series.chebyshev import constant_one
from engine.maps import Boundary, Bounds, distortion
from engine.maps.harmonic_map import HarmonicMap

OUTLINE, CAGE = SHAPE = letter_l()
BOUNDARY = Boundary.sample(Domain(OUTLINE, CAGE))
POINTS = np.concatenate([inner_points(OUTLINE, 30, 0), scattered_on(OUTLINE, 150)])
TIMES = np.concatenate([np.linspace(0, 1, 17), np.random.default_rng(3).uniform(0, 1, 4)])
ACCURACY = 1e-4  # relative, of the metric variant's integral equation near a cage vertex


def measured(interval, times=TIMES):
    """Return the largest k and σ_a and the smallest σ_b at the points."""
    frames = [interval.frame(float(time)) for time in times]
    found = [
        (
            distortion.k(f.fz, f.fzbar),
            distortion.sigma_a(f.fz, f.fzbar),
            distortion.sigma_b(f.fz, f.fzbar),
        )
        for f in frames
    ]
    k, sigma_a, sigma_b = (np.array(each) for each in zip(*found, strict=True))
    return k.max(), sigma_a.max(), sigma_b.min()


@pytest.mark.parametrize("variant", Variant)
@pytest.mark.parametrize("seed", [1, 4])
def test_nothing_is_beyond_what_is_proven_and_that_is_tight(variant, seed):
    maps = [random_map(SHAPE, 2 * seed + i, k=0.5, bend=0.8) for i in range(2)]
    interval = stage_of(SHAPE, POINTS).between(maps, variant)
    k, sigma_a, sigma_b = measured(interval)
    proof = prove(interval)
    slack = ACCURACY if variant is Variant.METRIC else 1e-9
    assert proof.k >= k * (1 - slack)
    assert proof.sigma_a >= sigma_a * (1 - slack)
    assert proof.is_locally_injective == (k < 1) == (proof.unproven_times == ())
    assert proof.not_tight == ()
    assert proof.sigma_b <= max(sigma_b * (1 + slack), 0.0)
    if proof.is_locally_injective:
        assert proof.sigma_b >= sigma_b * (1 - 0.02)
        assert proof.k <= k + 3 * TIGHTNESS + 1e-3
    assert proof.sigma_a <= sigma_a * (1 + 3 * TIGHTNESS + 1e-3)


@pytest.mark.parametrize("variant", Variant)
def test_motion_through_keyframes_is_proven(variant):
    maps = [random_map(SHAPE, seed, k=0.3, bend=0.5) for seed in (1, 2, 5, 8)]
    bounds = Bounds(k=0.6, sigma_a=4, sigma_b=0.2)
    options = {"variant": variant, "through": True, "bounds": bounds}
    if variant.needs_transform:
        options["transform"] = stage_of(SHAPE, POINTS).transform
    prepared = prepare(maps, BOUNDARY, POINTS[::3], **options)
    for interval in prepared.segments:
        k, sigma_a, sigma_b = measured(interval, TIMES[::4])
        proof = prove(interval)
        assert proof.k >= k - ACCURACY
        assert proof.sigma_a >= sigma_a * (1 - ACCURACY)
        assert proof.sigma_b <= max(sigma_b * (1 + ACCURACY), 0.0)
        assert proof.is_locally_injective == (proof.unproven_times == ())
        for start, end in proof.unproven_times:
            # It does fold there, or nearly.
            assert measured(interval, np.linspace(start, end, 7))[0] > 0.9
        if variant is Variant.METRIC:
            # It keeps the bounds, or what its keyframes have beyond them.
            own = [f.derivatives(BOUNDARY.points) for f in maps]
            assert proof.k <= max(0.6, *(distortion.k(*f).max() for f in own)) + 2 * TIGHTNESS
            assert proof.is_locally_injective


@pytest.mark.parametrize(
    ("variant", "through"),
    [
        (Variant.NU, True),
        (Variant.ETA, False),
        (Variant.SCALED_ETA, False),
        (Variant.METRIC, True),
        *(
            pytest.param(variant, through, marks=pytest.mark.long)
            for variant, through in (
                (Variant.NU, False),
                (Variant.ETA, True),
                (Variant.SCALED_ETA, True),
                (Variant.METRIC, False),
            )
        ),
    ],
)
def test_in_betweens_around_holes_are_proven(variant, through):
    shape = plate(2, 8)
    boundary = Boundary.sample(shape.domain)
    maps = [holed_map(shape, seed, 0.1) for seed in range(3 if through else 2)]
    points = boundary.points[::9]
    prepared = prepare(maps, boundary, points, variant=variant, through=through)
    interval = prepared.segments[0]
    assert interval.correction > 1e-3
    k, sigma_a, sigma_b = measured(interval, np.linspace(0, 1, 9))
    proof = prove(interval)
    slack = 2e-3 if variant is Variant.METRIC else 1e-7
    assert k * (1 - slack) <= proof.k
    assert sigma_a * (1 - slack) <= proof.sigma_a
    assert sigma_b * (1 + slack) >= proof.sigma_b
    assert proof.is_locally_injective
    assert proof.k <= k + 0.02
    assert proof.sigma_a <= 1.02 * sigma_a
    assert proof.sigma_b >= sigma_b - 0.02


def test_a_small_rho_is_proven_as_tightly_as_any_other():
    maps = [random_map(SHAPE, seed, k=0.85, bend=1.0) for seed in (0, 1)]
    points = np.concatenate([POINTS, scattered_on(OUTLINE, 600)])
    interval = stage_of(SHAPE, points).between(maps, "scaled-eta")
    times = np.linspace(0, 1, 33)
    assert min(map(interval.rho, times)) < 0.2
    k, sigma_a, sigma_b = measured(interval, times)
    proof = prove(interval)
    assert proof.unproven_times == ()
    assert k <= proof.k <= k + 2e-3
    assert sigma_a <= proof.sigma_a <= 1.002 * sigma_a
    assert sigma_b >= proof.sigma_b >= sigma_b - 0.002 * sigma_a


def test_what_folds_between_its_keyframes_is_not_proven():
    _, cage = bar()
    maps = [HarmonicMap.identity(cage), HarmonicMap(cage=cage, phi=-1.0 * cage, psi=0.0 * cage)]
    points = np.array([0.1, -1.3])
    linearly, by_nu = (
        prove(prepare(maps, boundary_of(bar()), points, variant=v).segments[0])
        for v in (Variant.LINEAR, Variant.NU)
    )
    assert not linearly.is_locally_injective
    assert linearly.sigma_b == 0
    assert (linearly.unproven_times[0][0], linearly.unproven_times[-1][1]) == pytest.approx(
        (0.5, 0.5), abs=0.01
    )
    assert by_nu.is_locally_injective
    assert by_nu.k == pytest.approx(0, abs=1e-8)
    assert (by_nu.sigma_a, by_nu.sigma_b) == pytest.approx((1, 1), abs=2 * TIGHTNESS)


def test_where_nothing_is_proven_sigma_b_is_0(monkeypatch):
    monkeypatch.setattr(bisection, "MOST_CELLS", 1)
    maps = [random_map(SHAPE, seed, k=0.95, bend=1.0) for seed in range(2)]
    interval = stage_of(SHAPE, POINTS[:2]).between(maps, "nu")
    proof = prove(interval)
    assert proof.k < 1
    assert proof.sigma_b == 0
    assert not proof.is_locally_injective
    assert proof.unproven_times


def test_times_that_cannot_be_settled_are_named(monkeypatch):
    monkeypatch.setattr(bisection, "MOST_CELLS", 1)
    maps = [HarmonicMap.identity(CAGE), random_map(SHAPE, 3, k=0.5, bend=0.8)]
    interval = stage_of(SHAPE, POINTS[:2]).between(maps, "eta")
    proof = prove(interval)
    assert proof.is_locally_injective
    assert proof.unproven_times == ()
    assert proof.not_tight
    monkeypatch.undo()
    better = prove(interval)
    assert better.not_tight == better.unproven_times == ()
    assert better.k <= proof.k
    assert better.sigma_b >= proof.sigma_b


@pytest.mark.parametrize("name", ["log_modulus", "nu", "conj_eta", "trace", "conformal"])
def test_curves_along_a_piece_hold_everywhere_on_it(name):
    maps = [random_map(SHAPE, seed, k=0.8, bend=1.0) for seed in range(3)]
    pieces = Subdivision.of([f.coefficients for f in maps], BOUNDARY)
    pieces.halve(np.arange(0, len(BOUNDARY.points), 3))
    pieces.halve(np.arange(len(BOUNDARY.points), len(pieces.halves), 2))
    controls, errors = getattr(pieces.derivatives(0), name)()
    assert controls.shape[:2] == errors.shape == (len(pieces.halves), 3)
    for s in (0.0, 0.21, 0.5, 0.83, 1.0):
        points = pieces.starts + s * (pieces.ends - pieces.starts)
        basis = [1 - s, s] if controls.shape[2] == 2 else [(1 - s) ** 2, 2 * s * (1 - s), s * s]
        for key, f in enumerate(maps):
            fz, g = f.derivatives(points)[0], f.derivatives(points)[1].conj()
            truth = {
                "log_modulus": np.log(np.abs(fz)),
                "nu": g / fz,
                "conj_eta": fz * g,
                "trace": np.abs(fz) ** 2 + np.abs(g) ** 2,
                "conformal": fz,
            }[name]
            assert (np.abs(controls[:, key] @ basis - truth) <= errors[:, key]).all()
    assert np.median(errors[errors < np.inf]) < 1e-3


def bernstein(degree, x):
    n = np.arange(degree + 1)
    return np.array([1, 3, 3, 1] if degree == 3 else [1, 2, 1] if degree == 2 else [1, 1]) * (
        x[..., None] ** n * (1 - x[..., None]) ** (degree - n)
    )


def linearly(patch, s, t):
    controls = patch.controls[0]
    along = controls[:, :1] * (1 - s) + controls[:, 1:] * s
    return along[0] * (1 - t) + along[1] * t


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.sampled_from([1, 3]))
def test_cells_enclose_what_is_blended_on_them(seed, degree):
    rng = np.random.default_rng(seed)
    size = 10 ** rng.uniform(-3, 0)

    def patch(middle, columns, *, is_complex):
        shape = (1, degree + 1, columns)
        noise = rng.normal(size=shape) + (1j * rng.normal(size=shape) if is_complex else 0)
        return BernsteinPatch(middle + size * noise, np.array([0.0]))

    s, t = rng.uniform(size=(2, 200))

    def values(patch):
        return np.einsum(
            "pd,db,pb->p",
            bernstein(degree, t),
            patch.controls[0],
            bernstein(patch.controls.shape[2] - 1, s),
        )

    a = patch(rng.normal(), 2, is_complex=False)
    nu = patch(rng.uniform(0, 0.9) * np.exp(1j * rng.uniform(0, 7)), 2, is_complex=True)
    eta = patch(0.3 * (rng.normal() + 1j * rng.normal()), 3, is_complex=True)
    trace = patch(rng.uniform(0.5, 3), 3, is_complex=False)
    f, g = patch(1j, 2, is_complex=True), patch(0.5, 2, is_complex=True)
    h, rho, factor = (patch(rng.normal() / 9, 2, is_complex=False) for _ in range(3))
    if degree > 1:  # changes are linear in time
        h, rho, factor = (
            BernsteinPatch(each.controls[:, [0, -1]], each.error) for each in (h, rho, factor)
        )
    changes = BlendChanges(h, rho, factor)
    size_a, by_h = np.exp(values(a)), np.exp(linearly(h, s, t))
    by_rho, by_factor = np.exp(linearly(rho, s, t)), np.exp(linearly(factor, s, t))
    size_eta = np.abs(values(eta))
    pairs = [
        (NuBlend.enclose(a, nu, None), size_a, size_a * np.abs(values(nu))),
        (EtaBlend.enclose(a, eta, None), size_a, size_eta / size_a),
        (
            EtaBlend.enclose(a, eta, changes),
            size_a * by_h * by_factor,
            size_eta / (size_a * by_h) * by_rho,
        ),
        (LinearBlend.enclose(f, g, None), np.abs(values(f)), np.abs(values(g))),
    ]
    squares = values(trace), 2 * np.abs(values(eta))
    if (squares[0] > squares[1]).all():
        largest, least = np.sqrt(squares[0] + squares[1]), np.sqrt(squares[0] - squares[1])
        fz, fzbar = (largest + least) / 2, (largest - least) / 2
        pairs += [
            (MetricBlend.enclose(trace, eta, None), fz, fzbar),
            (
                MetricBlend.enclose(trace, eta, changes),
                fz * by_h * by_factor,
                fzbar / by_h * by_rho,
            ),
        ]
    for (k, sigma_a, sigma_b), fz, fzbar in pairs:
        assert k[0] >= (fzbar / fz).max() - 1e-12
        assert sigma_a[0] >= (fz + fzbar).max() - 1e-12
        assert sigma_b[0] <= max((fz - fzbar).min(), 0) + 1e-12


def test_a_course_is_cut_exactly():
    course = TimeWeights.between(Tangent(InteriorKnot(1.0, 2.0), 0.7, 0.7), 0.0)
    start, end = np.array([0.0, 0.3]), np.array([1.0, 0.35])
    controls = course.controls_on(start, end)
    for x in (0.0, 0.4, 1.0):
        weights = np.einsum("d,cdq->cq", bernstein(3, np.array(x)), controls)
        np.testing.assert_allclose(weights, course.at(start + x * (end - start)).T, atol=1e-14)


def test_the_bound_on_rho_encloses_it_and_is_near():
    maps = [random_map(SHAPE, seed, k=0.6, bend=1.0) for seed in (3, 6)]
    interval = stage_of(SHAPE, POINTS[:2]).between(maps, "scaled-eta")
    rng = np.random.default_rng(0)
    starts = np.concatenate([rng.uniform(size=300), [0.0, 1e-9, 0.999999]])
    ends = np.minimum(starts + 10.0 ** rng.uniform(-9, -2, len(starts)), 1.0)
    values, errors = interval.scale.enclosures().linear_enclosures(starts, ends)
    share = np.linspace(0, 1, 20)
    for start, end, ends_of, error in zip(starts, ends, values, errors, strict=True):
        rho = interval.scale.at(start + share * (end - start))
        off = np.abs(np.log(rho) - (1 - share) * ends_of[0] - share * ends_of[1])
        assert off.max() <= error + 1e-15
        assert error <= off.max() + 5e-3


def correction_of(shape, holes=(), seed=0, size=0.05):
    """Return a correction of random functions over a shape's span, the same at all times."""
    rng = np.random.default_rng(seed)
    count = len(HarmonicMap.identity(shape[1], holes).coefficients)
    draw = rng.normal(size=(2, count, 2)) * size
    # Logarithms are not single-valued.
    draw[:, count - len(holes) :] = 0.0
    h, q = (draw[0] + 1j * draw[1]).T
    return CorrectionSeries(
        series=constant_one(), h=h[:, None], q=q[:, None], shifts=np.array([0.3 - 0.1j])
    )


# Each variant with two of the four, which make each pair with another variant.
@pytest.mark.parametrize(
    ("variant", "holed", "through"),
    [
        pytest.param(
            variant,
            holed,
            through,
            marks=() if (number + holed + through) % 2 == 0 else pytest.mark.long,
        )
        for number, variant in enumerate(Variant)
        for holed in (False, True)
        for through in (False, True)
    ],
)
def test_proof_of_a_corrected_frame_is_tight(variant, holed, through):
    shape = plate(2, 8) if holed else None
    outline, cage, holes = (shape.outline, shape.cage, shape.holes) if holed else (*SHAPE, ())
    boundary = Boundary.sample(Domain(outline, cage, holes))
    draw = (
        (lambda seed: holed_map(shape, seed, 0.1))
        if holed
        else (lambda seed: random_map(SHAPE, seed, k=0.3, bend=0.5))
    )
    maps = [draw(seed) for seed in range(3 if through else 2)]
    ends = boundary.points[boundary.next_samples]
    points = np.concatenate(
        [boundary.points, *(boundary.points * (1 - s) + ends * s for s in (0.33, 0.66))]
    )
    bounds = Bounds(k=0.8, sigma_a=5, sigma_b=0.1)
    interval = prepare(
        maps, boundary, points, variant=variant, through=through, bounds=bounds
    ).segments[0]
    # One after the other, as a track comes after handles that stay.
    for seed in range(2):
        interval = interval.with_correction(correction_of((outline, cage), holes, seed))
    for time in (0.0, 0.37, 0.8):
        frame = interval.frame(time)
        k = distortion.k(frame.fz, frame.fzbar).max()
        sigma_a = distortion.sigma_a(frame.fz, frame.fzbar).max()
        sigma_b = distortion.sigma_b(frame.fz, frame.fzbar).min()
        proof = prove(interval, time)
        if k >= 1:
            assert not proof.is_locally_injective
            continue
        assert k <= proof.k <= k + 0.01
        assert sigma_a <= proof.sigma_a <= 1.01 * sigma_a
        assert sigma_b * 0.98 - 0.005 <= proof.sigma_b <= sigma_b


def test_proof_refuses_sites_without_samples():
    maps = [random_map(SHAPE, seed, k=0.3, bend=0.5) for seed in (1, 2)]
    interval = stage_of(SHAPE, POINTS).between(maps, "nu").with_correction(correction_of(SHAPE))
    with pytest.raises(EngineError, match=says(NO_SAMPLES)):
        prove(interval, 0.5)
