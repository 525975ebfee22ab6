"""Harmonic maps of domains without holes and with."""

import numpy as np
import pytest
from holed_shapes import Holed, inner_points, plate, random_map as holed_map, ring
from hypothesis import given, settings, strategies as st
from messages import says
from numpy.testing import assert_allclose
from shapes import points_inside_disc, regular_polygon

from engine.arrays import NOT_COMPLEX
from engine.errors import EngineError
from engine.maps import distortion
from engine.maps.harmonic_map import COEFFICIENT_COUNT, HarmonicMap

CAGE = regular_polygon(20, 1.2)
POINTS = points_inside_disc(1.0, 80, seed=5)
# A shape, and points in it: without holes and with.
DOMAINS = {
    "disc": (Holed(outline=regular_polygon(20), cage=CAGE, holes=(), anchor=0j), POINTS),
    "one hole": (ring(), inner_points(ring(), 150)),
    "three holes": (plate(3), inner_points(plate(3), 150)),
}


def random_map(seed: int, size: float = 0.1) -> HarmonicMap:
    rng = np.random.default_rng(seed)
    phi, psi = rng.normal(size=(2, 20)) + 1j * rng.normal(size=(2, 20))
    return HarmonicMap(cage=CAGE, phi=CAGE + size * phi, psi=size * psi)


def test_affine_maps_are_exact():
    a, b, c = 1.5 + 0.5j, 0.3 - 0.2j, 7 - 2j
    affine = HarmonicMap(cage=CAGE, phi=a * CAGE + c, psi=np.conj(b) * CAGE)
    assert_allclose(affine(POINTS), a * POINTS + b * POINTS.conj() + c, rtol=0, atol=1e-13)
    fz, fzbar = affine.derivatives(POINTS)
    assert_allclose(fz, a, rtol=0, atol=1e-13)
    assert_allclose(fzbar, b, rtol=0, atol=1e-13)
    singular_values = np.linalg.svd(
        [[a.real + b.real, b.imag - a.imag], [a.imag + b.imag, a.real - b.real]], compute_uv=False
    )
    assert_allclose(distortion.sigma_a(fz, fzbar), singular_values[0], rtol=1e-13, atol=0)
    assert_allclose(distortion.sigma_b(fz, fzbar), singular_values[1], rtol=1e-12, atol=0)


@pytest.mark.parametrize("name", DOMAINS)
def test_the_identity_and_similarities_are_exact(name):
    shape, points = DOMAINS[name]
    identity = HarmonicMap.identity(shape.cage, shape.holes)
    assert_allclose(identity(points), points, rtol=0, atol=1e-14)
    similarity = HarmonicMap.similarity(shape.cage, shape.holes, factor=2j, shift=5)
    assert_allclose(similarity(points), 2j * points + 5, rtol=0, atol=1e-13)


@pytest.mark.parametrize("name", DOMAINS)
@given(seed=st.integers(0, 10_000))
@settings(max_examples=20)
def test_derivatives_agree_with_finite_differences(name, seed):
    shape, points = DOMAINS[name]
    f = random_map(seed) if name == "disc" else holed_map(shape, seed)
    h, atol = (1e-3, 1e-7) if name == "disc" else (2e-4, 1e-8)
    by_x, by_y = (
        (
            8 * (f(points + h * d) - f(points - h * d))
            - (f(points + 2 * h * d) - f(points - 2 * h * d))
        )
        / (12 * h)
        for d in (1, 1j)
    )
    fz, fzbar = f.derivatives(points)
    assert_allclose(fz, (by_x - 1j * by_y) / 2, rtol=0, atol=atol)
    assert_allclose(fzbar, (by_x + 1j * by_y) / 2, rtol=0, atol=atol)
    (second,) = f.span.evaluate(f.coefficients, points, orders=(2,))
    ahead, behind = f.derivatives(points + h), f.derivatives(points - h)
    far_ahead, far_behind = f.derivatives(points + 2 * h), f.derivatives(points - 2 * h)
    for derivative, order in ((second[:, 0], 0), (second[:, 1].conj(), 1)):
        difference = 8 * (ahead[order] - behind[order]) - (far_ahead[order] - far_behind[order])
        assert_allclose(derivative, difference / (12 * h), rtol=0, atol=1e-5)


def test_the_gauge_does_not_change_the_map():
    f = random_map(1)
    c = 3 - 4j
    g = HarmonicMap(cage=CAGE, phi=f.phi + c, psi=f.psi - np.conj(c))
    assert_allclose(g(POINTS), f(POINTS), rtol=0, atol=1e-13)


def test_nu_and_eta_are_holomorphic_and_antiholomorphic():
    f = random_map(2)
    h = 1e-5
    nu_by, eta_by = [], []
    for d in (1, 1j):
        ahead, behind = f.derivatives(POINTS + h * d), f.derivatives(POINTS - h * d)
        nu_by.append((distortion.nu(*ahead) - distortion.nu(*behind)) / (2 * h))
        eta_by.append((distortion.eta(*ahead) - distortion.eta(*behind)) / (2 * h))
    assert_allclose(nu_by[0] + 1j * nu_by[1], 0, rtol=0, atol=1e-6)
    assert_allclose(eta_by[0] - 1j * eta_by[1], 0, rtol=0, atol=1e-6)
    assert np.abs(nu_by[0]).max() > 0.1


@given(st.integers(0, 10_000))
def test_distortions_agree_with_each_other(seed):
    fz, fzbar = random_map(seed, 0.02).derivatives(POINTS)
    k = distortion.k(fz, fzbar)
    assert_allclose(np.abs(distortion.mu(fz, fzbar)), k, rtol=1e-12, atol=1e-300)
    assert_allclose(np.abs(distortion.nu(fz, fzbar)), k, rtol=1e-12, atol=1e-300)
    assert_allclose(
        distortion.eta(fz, fzbar), distortion.mu(fz, fzbar) * np.abs(fz) ** 2, rtol=1e-12
    )
    inside = k < 1
    fz, fzbar, k = fz[inside], fzbar[inside], k[inside]
    assert_allclose(distortion.K(fz, fzbar), (1 + k) / (1 - k), rtol=1e-9, atol=0)
    assert np.all(distortion.tau(fz, fzbar) >= 1)


@pytest.mark.parametrize(
    ("phi", "message"),
    [
        (CAGE[:-1], says(COEFFICIENT_COUNT)),
        (np.full(20, np.nan), "finite"),
        (CAGE.reshape(4, 5), "one-dimensional"),
        (["a"] * 20, says(NOT_COMPLEX)),
    ],
)
def test_bad_coefficients_are_refused(phi, message):
    with pytest.raises(EngineError, match=message):
        HarmonicMap(cage=CAGE, phi=phi, psi=CAGE)


def test_outside_its_domain_a_map_is_nan():
    shape = ring()
    f = HarmonicMap.identity(shape.cage, shape.holes)
    inside, outside = [0.75, -0.6 + 0.2j], [0.1, 3.0, -2.5j, 5 + 5j]
    places, slopes = f([*inside, *outside]), f.derivatives([*inside, *outside])
    assert_allclose(places[:2], inside, rtol=0, atol=1e-12)
    assert_allclose(slopes[0][:2], 1, rtol=0, atol=1e-12)
    assert all(np.isnan(values[2:]).all() for values in (places, *slopes))


@pytest.mark.parametrize("points", [0.5, "0.5", [[0.5]], [np.nan]])
def test_points_that_are_no_list_of_numbers_are_refused(points):
    f = HarmonicMap.identity(regular_polygon(8))
    for of in (f, f.derivatives):
        with pytest.raises(EngineError, match="points must be"):
            of(points)
