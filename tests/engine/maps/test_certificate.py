import numpy as np
import pytest
from deform_shapes import STAR_POINTS, dense_outline, extremes, star, star_boundary
from hypothesis import given, settings, strategies as st
from messages import says
from numpy.testing import assert_allclose, assert_array_equal
from scipy.linalg import eigh

from engine.arrays import FEW_ENTRIES
from engine.deform.deformer import UNCERTIFIED_START
from engine.errors import EngineError
from engine.geometry import Domain
from engine.geometry.polygon import CAGE_ORDER, CAGE_TOUCHES
from engine.maps import (
    Boundary,
    Bounds,
    LocalBounds,
    certificate as certificate_module,
    certify,
    certify_segments,
    segment_enclosures,
)
from engine.maps.bounds import IMPOSSIBLE_BOUND, IMPOSSIBLE_SIGMA_A
from engine.maps.cauchy import cauchy_derivatives
from engine.maps.certificate import OTHER_SPAN
from engine.maps.harmonic_map import HarmonicMap

BOUNDARY = star_boundary()
CAGE = BOUNDARY.cage
LOOSE = Bounds(k=0.99, sigma_a=100.0, sigma_b=0.001)


def over_cage(phi, psi):
    return HarmonicMap(cage=CAGE, phi=phi, psi=psi)


def noisy(seed, size):
    rng = np.random.default_rng(seed)
    noise = rng.normal(size=(2, len(CAGE))) + 1j * rng.normal(size=(2, len(CAGE)))
    return over_cage(CAGE + size * noise[0], size * noise[1])


@settings(max_examples=25)
@given(st.integers(0, 10**6), st.sampled_from([0.001, 0.005, 0.015, 0.03]))
def test_the_reported_bounds_enclose_the_true_ones(seed, size):
    f = noisy(seed, size)
    certificate = certify(f, BOUNDARY, Bounds())
    points = dense_outline(BOUNDARY, 6000)
    points = np.concatenate([points, 0.5 * BOUNDARY.outline, 0.9 * BOUNDARY.outline])
    k, sigma_a, sigma_b = extremes(f, points)
    assert k <= certificate.k
    assert sigma_a <= certificate.sigma_a
    assert sigma_b >= certificate.sigma_b
    if certificate.is_certified:
        assert certificate.k <= k + 0.004
        assert certificate.sigma_a <= 1.004 * sigma_a
        assert certificate.sigma_b >= sigma_b - 0.004 * sigma_a


def test_segments_as_they_are_enclose_what_bisection_narrows(monkeypatch):
    monkeypatch.setattr(certificate_module, "TIGHTNESS", 1e-7)
    f = noisy(2, 0.015)
    certificate, _, enclosures = certify_segments(f, BOUNDARY, LOOSE)
    for found, alone in zip(enclosures, segment_enclosures(f, BOUNDARY), strict=True):
        assert_array_equal(found, alone)
    assert certificate.k < enclosures.k.max()
    assert certificate.sigma_a < enclosures.sigma_a.max()
    assert certificate.sigma_b > enclosures.sigma_b.min()


def test_affine_maps_have_exact_certificates():
    certificate = certify(over_cage((1.5 + 1j) * CAGE + 9, 0.4 * CAGE), BOUNDARY, Bounds())
    a = abs(1.5 + 1j)
    assert certificate.is_certified
    assert certificate.winding == 0
    assert_allclose(certificate.k, 0.4 / a, rtol=1e-8)
    assert_allclose(certificate.sigma_a, a + 0.4, rtol=1e-8)
    assert_allclose(certificate.sigma_b, a - 0.4, rtol=1e-8)


def test_a_far_shape_loses_no_digits():
    shift = 1e6 - 3e6j
    far = Boundary.sample(Domain(BOUNDARY.outline + shift, CAGE + shift))
    f = noisy(1, 0.01)
    moved = HarmonicMap(cage=far.cage, phi=f.phi + shift, psi=f.psi - shift)
    near, there = certify(f, BOUNDARY, Bounds()), certify(moved, far, Bounds())
    assert_allclose(there.k, near.k, rtol=1e-5)
    assert_allclose(there.sigma_b, near.sigma_b, rtol=1e-5)


@pytest.mark.parametrize("excess", [1e-6, -1e-6])
def test_k_just_beside_its_bound(excess):
    f = noisy(2, 0.01)
    k, _, _ = extremes(f, dense_outline(BOUNDARY, 200_000))
    certificate = certify(f, BOUNDARY, Bounds(k=k * (1 - excess)))
    assert certificate.is_certified is (excess < 0)
    assert certificate.k >= k * (1 - 1e-9)


def test_each_bound_is_tested():
    f = noisy(3, 0.01)
    wide = certify(f, BOUNDARY, LOOSE)
    assert wide.is_certified
    assert not certify(f, BOUNDARY, Bounds(k=0.9 * wide.k)).is_certified
    assert not certify(f, BOUNDARY, Bounds(sigma_a=0.98 * wide.sigma_a)).is_certified
    assert not certify(f, BOUNDARY, Bounds(sigma_b=1.05 * wide.sigma_b)).is_certified


def test_zeros_inside_are_counted():
    # f_z = a product of linear factors with its zeros inside, well off the outline.
    rows = BOUNDARY.derivatives
    for zeros in ([0.0], [0.1, -0.2j], [0.1, -0.1, 0.15j]):
        wanted = np.prod([BOUNDARY.points - zero for zero in zeros], axis=0)
        phi, *_ = np.linalg.lstsq(rows, wanted, rcond=1e-12)
        certificate = certify(over_cage(phi, np.zeros_like(phi)), BOUNDARY, LOOSE)
        assert certificate.winding == len(zeros)
        assert not certificate.is_certified
        assert certificate.k == np.inf


def hidden_between_vertices(height):
    """Return a map whose f_z̄ is small at the outline's vertices and large between them."""
    at_vertices = cauchy_derivatives(CAGE, BOUNDARY.outline)[:, 1:]
    middles = (BOUNDARY.outline + np.roll(BOUNDARY.outline, -1)) / 2
    between = cauchy_derivatives(CAGE, middles)[:, 1:]
    _, vectors = eigh(at_vertices.conj().T @ at_vertices, between.conj().T @ between)
    psi = np.append(0, vectors[:, 0])
    return over_cage(CAGE.copy(), height * psi)


def test_a_fold_between_the_samples_is_found(monkeypatch):
    # With samples as sparse as the vertices the certificate must bisect its way to the fold.
    monkeypatch.setattr("engine.maps.boundary.SEGMENT_PER_DISTANCE", 1e9)
    monkeypatch.setattr("engine.maps.boundary.SEGMENT_PER_SIZE", 1e9)
    sparse = Boundary.sample(Domain(BOUNDARY.outline, CAGE))
    assert len(sparse.points) == len(BOUNDARY.outline)
    hidden = 0
    for height in np.geomspace(0.01, 10, 25):
        f = hidden_between_vertices(height)
        at_samples = extremes(f, sparse.points)
        k, sigma_a, sigma_b = extremes(f, dense_outline(BOUNDARY, 20_000))
        for boundary in (sparse, BOUNDARY):
            certificate = certify(f, boundary, LOOSE)
            assert certificate.sigma_b <= sigma_b
            assert certificate.k >= k
            assert certificate.sigma_a >= sigma_a
            assert certificate.is_certified is LOOSE.allow(k=k, sigma_a=sigma_a, sigma_b=sigma_b)
        hidden += LOOSE.allow(k=at_samples[0], sigma_a=1, sigma_b=at_samples[2]) and sigma_b < 0
    assert hidden > 0


def test_a_vanishing_derivative_on_the_outline_is_not_certified():
    rows = BOUNDARY.derivatives
    place = (BOUNDARY.points[3] + BOUNDARY.points[4]) / 2
    phi, *_ = np.linalg.lstsq(rows, BOUNDARY.points - place, rcond=1e-12)
    certificate = certify(over_cage(phi, 0 * phi), BOUNDARY, LOOSE)
    assert not certificate.is_certified
    assert certificate.k == np.inf
    assert not certify(over_cage(0 * CAGE, 0 * CAGE), BOUNDARY, LOOSE).is_certified


def test_garbage_is_not_certified():
    rng = np.random.default_rng(7)
    phi, psi = rng.normal(size=(2, len(CAGE))) * 1e6
    assert not certify(over_cage(phi, psi), BOUNDARY, LOOSE).is_certified


OVERFLOWING = 1e308 * np.exp(1j * np.arange(len(CAGE)))


@pytest.mark.parametrize(
    ("phi", "psi"), [(CAGE, OVERFLOWING), (OVERFLOWING, 0 * CAGE), (OVERFLOWING, OVERFLOWING)]
)
def test_what_overflows_is_not_certified(phi, psi):
    certificate = certify(over_cage(phi, psi), BOUNDARY, LOOSE)
    assert not certificate.is_certified
    assert certificate.k == np.inf
    assert certificate.sigma_b < 0


def test_one_sample_that_is_not_a_number_is_enough_to_refuse():
    # Only G has it there: all that compares with it is false.
    segments = certificate_module._Segments(
        nodes=np.array(
            [
                [BOUNDARY.points[:3], np.roll(BOUNDARY.points[:3], -1)],
                [[1, 1, 1], [1, 1, 1]],
                [[0, np.nan, 0], [np.nan, 0, 0]],
            ]
        ),
        errors=np.zeros((2, 3)),
        origins=np.arange(3),
        span=BOUNDARY.span,
        coefficients=np.column_stack([CAGE, 0 * CAGE]),
    )
    proof, broken, _ = certificate_module._bisect(BOUNDARY, segments, LOOSE)
    assert not proof.is_certified
    assert proof.k == np.inf
    assert {0, 1} <= set(broken.tolist())


def test_a_certificate_tells_what_it_was_made_for():
    bounds = Bounds(k=0.3)
    certificate = certify(noisy(3, 0.01), BOUNDARY, bounds)
    assert certificate.limits is bounds
    assert not bounds.allow(k=np.nan, sigma_a=1.0, sigma_b=1.0)
    assert not bounds.allow(k=0.1, sigma_a=np.nan, sigma_b=1.0)
    assert not bounds.allow(k=0.1, sigma_a=1.0, sigma_b=np.nan)


def test_limits_hold_any_numbers():
    # A map of twice the size is held to limits that the identity does not keep.
    f = over_cage(2 * CAGE, 0 * CAGE)
    assert certify(f, BOUNDARY, LocalBounds(k=0.5, sigma_a=3.0, sigma_b=1.5)).is_certified
    assert not certify(f, BOUNDARY, LocalBounds(k=0.5, sigma_a=3.0, sigma_b=2.1)).is_certified


def test_segments_are_refined_in_any_order():
    sorted_, mixed = (BOUNDARY.refined(np.array(s)) for s in ([2, 5, 9], [9, 2, 5, 2]))
    assert_array_equal(mixed.points, sorted_.points)
    assert_array_equal(mixed.half_lengths, sorted_.half_lengths)
    assert_array_equal(mixed.derivatives, sorted_.derivatives)
    assert_array_equal(mixed.third_derivative_kernel, sorted_.third_derivative_kernel)
    assert_allclose(mixed.derivatives, cauchy_derivatives(CAGE, mixed.points), atol=1e-12)


def test_refining_changes_no_result():
    f = noisy(4, 0.01)
    finer = BOUNDARY.refined(np.array([0, 5, 6, len(BOUNDARY.points) - 1]))
    assert len(finer.points) == len(BOUNDARY.points) + 4
    assert_allclose(finer.weights.sum(), 1)
    assert_allclose(2 * finer.half_lengths.sum(), 2 * BOUNDARY.half_lengths.sum())
    assert_allclose(np.abs(np.roll(finer.points, -1) - finer.points) / 2, finer.half_lengths)
    fresh = HarmonicMap(cage=CAGE, phi=f.phi, psi=f.psi).derivatives(finer.points)[0]
    assert_allclose(finer.derivatives @ f.phi, fresh, atol=1e-12)
    one, two = certify(f, BOUNDARY, Bounds()), certify(f, finer, Bounds())
    assert_allclose(two.k, one.k, atol=0.003)
    assert two.is_certified == one.is_certified


def test_another_cage_is_refused():
    f = HarmonicMap(cage=CAGE + 1, phi=CAGE, psi=0 * CAGE)
    with pytest.raises(EngineError, match=says(OTHER_SPAN)):
        certify(f, BOUNDARY, Bounds())


@pytest.mark.parametrize(
    ("outline", "cage", "message"),
    [
        (BOUNDARY.outline, 0.9 * CAGE, says(CAGE_TOUCHES)),
        (BOUNDARY.outline, 0.2 * CAGE, "inside|contain"),
        (BOUNDARY.outline, CAGE + 9, says(CAGE_ORDER)),
        (BOUNDARY.outline, CAGE[::-1], says(CAGE_ORDER)),
        (BOUNDARY.outline[::-1], CAGE, "clockwise"),
        (BOUNDARY.outline[[0, 2, 1, *range(3, len(CAGE))]], CAGE, "crosses"),
        (np.where(np.arange(len(CAGE)) == 2, np.nan, BOUNDARY.outline), CAGE, "finite"),
        (BOUNDARY.outline, CAGE[:2], says(FEW_ENTRIES, at_least=3)),
    ],
)
def test_bad_shapes_are_refused(outline, cage, message):
    with pytest.raises(EngineError, match=message):
        Boundary.sample(Domain(outline, cage))


@pytest.mark.parametrize(
    "bounds",
    [
        *[{"k": value} for value in (0.0, 1.0, -0.5, np.nan)],
        *[{"sigma_a": value} for value in (1.0, 0.5, np.inf, np.nan)],
        *[{"sigma_b": value} for value in (1.0, 1.2, 0.0, -0.1, np.nan)],
    ],
)
def test_bounds_without_the_identity_are_refused(bounds):
    message = IMPOSSIBLE_SIGMA_A if "sigma_a" in bounds else IMPOSSIBLE_BOUND
    with pytest.raises(EngineError, match=says(message)):
        Bounds(**bounds)


def test_a_start_map_must_be_certified():
    deformer = star()
    with pytest.raises(EngineError, match=says(UNCERTIFIED_START)):
        deformer.start(over_cage(CAGE, 0.9 * CAGE))
    with pytest.raises(EngineError, match="folds"):
        deformer.resume(over_cage(CAGE, 1.1 * CAGE))
    assert deformer.start().certificate.is_certified
    assert len(STAR_POINTS) == len(deformer.positions(deformer.start()))


def test_a_chord_that_passes_near_zero_bounds_the_segment(monkeypatch):
    # Without bisection: f_z = t + 0.1 i for t from −1 to 1, exactly linear.
    monkeypatch.setattr(certificate_module, "FINEST", 1)
    ends = np.array([[0, 1], [-1 + 0.1j, 1 + 0.1j], [0, 0]])
    segment = certificate_module._Segments(
        nodes=ends[:, :, None],
        errors=np.zeros((2, 1)),
        origins=np.array([0]),
        span=BOUNDARY.span,
        coefficients=np.zeros((len(CAGE), 2), np.complex128),
    )
    found, _, _ = certificate_module._bisect(BOUNDARY, segment, LOOSE)
    assert_allclose(found.sigma_b, 0.1, rtol=1e-6)
