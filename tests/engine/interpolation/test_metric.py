"""The metric on the outline: Equations (9) to (13) and Lemma 7."""

import numpy as np
from hypothesis import given, settings, strategies as st
from numpy.testing import assert_allclose

from engine.interpolation import TimeWeights
from engine.interpolation.blends.outline import OutlineMetric
from engine.interpolation.series.chebyshev import separate_variables
from engine.maps import Bounds


def random_derivatives(seed, *, k=1.0, count=400):
    """Return f_z and f_z̄ of two locally injective maps, with dilatations up to k."""
    rng = np.random.default_rng(seed)
    fz = np.exp(rng.normal(size=(2, count)) + 1j * rng.uniform(-3, 3, (2, count)))
    turn = np.exp(1j * rng.uniform(-np.pi, np.pi, (2, count)))
    return fz, k * rng.uniform(0, 1, (2, count)) ** 0.2 * np.abs(fz) * turn


def jacobian(fz, fzbar):
    """Return the matrices of dz ↦ fz dz + fzbar conj(dz), (..., 2, 2)."""
    by_x, by_y = fz + fzbar, 1j * (fz - fzbar)
    return np.stack([[by_x.real, by_y.real], [by_x.imag, by_y.imag]]).transpose(2, 0, 1)


@given(seed=st.integers(0, 10_000), time=st.floats(0, 1))
@settings(max_examples=30)
def test_lemma_7_the_discriminant_is_positive_and_as_the_lemma_has_it(seed, time):
    fz, fzbar = random_derivatives(seed)
    metric = OutlineMetric.of(fz, fzbar, TimeWeights.straight(), Bounds())
    a, eta = metric.trace, metric.eta
    trace = (1 - time) * a[0] + time * a[1]
    blended = (1 - time) * eta[0] + time * eta[1]
    discriminant = trace**2 - 4 * np.abs(blended) ** 2
    determinant = np.abs(fz) ** 2 - np.abs(fzbar) ** 2
    sigma_b = np.abs(fz) - np.abs(fzbar)
    bound = ((1 - time) * determinant[0]) ** 2 + (time * determinant[1]) ** 2
    bound += 2 * time * (1 - time) * (a[0] * sigma_b[1] ** 2 + 2 * sigma_b[0] ** 2 * np.abs(eta[1]))
    assert np.all(bound > 0)
    assert np.all(discriminant >= bound - 1e-12 * trace**2)


@given(seed=st.integers(0, 10_000), time=st.floats(0, 1))
@settings(max_examples=20)
def test_the_root_of_equation_13_has_the_blended_metric_tensor(seed, time):
    fz, fzbar = random_derivatives(seed, k=0.99)
    metric = OutlineMetric.of(fz, fzbar, TimeWeights.straight(), Bounds())
    weights = np.array([1 - time, time])
    modulus = np.exp(metric.residuals(np.array([time]))[:, 0] + weights @ metric.log_modulus)
    # Any rotation has the same metric; f_z̄ follows from η, up to conjugation.
    other = (weights @ metric.eta).conj() / modulus
    found, first, second = (
        np.swapaxes(j, 1, 2) @ j
        for j in (jacobian(modulus, other), jacobian(fz[0], fzbar[0]), jacobian(fz[1], fzbar[1]))
    )
    scale = np.abs(first).max() + np.abs(second).max()
    assert_allclose(found, (1 - time) * first + time * second, rtol=0, atol=1e-10 * scale)
    assert np.all(modulus > np.abs(other))


def test_the_residual_is_written_in_few_products_and_vanishes_at_the_keyframes():
    fz, fzbar = random_derivatives(2, k=0.7)
    metric = OutlineMetric.of(fz, fzbar, TimeWeights.straight(), Bounds())
    modes, series = separate_variables(metric.residuals, tolerance=1e-10, left_out=1e-8)
    times = np.random.default_rng(0).random(30)
    found = np.array([modes @ series(time) for time in times]).T
    assert_allclose(modes @ series.at(times), found, rtol=0, atol=1e-13)
    assert_allclose(found, metric.residuals(times), rtol=0, atol=1e-8)
    for time in (0.0, 1.0):
        assert_allclose(series(time), 0, rtol=0, atol=1e-15)


def test_between_equal_keyframes_there_is_no_residual():
    fz, fzbar = random_derivatives(3, k=0.7)
    same = np.stack([fz[0], fz[0]]), np.stack([fzbar[0], fzbar[0]])
    metric = OutlineMetric.of(*same, TimeWeights.straight(), Bounds())
    for values in (metric.residuals, lambda times: np.zeros((5, len(times)))):
        modes, series = separate_variables(values, tolerance=1e-10, left_out=1e-8)
        assert modes.shape[1] == 1
        assert_allclose(modes @ series(0.3), 0, rtol=0, atol=1e-14)
