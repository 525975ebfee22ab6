"""Enclosures of the distortion on a piece of the boundary during a piece of time.

What a variant blends is a polynomial in time, and along a piece a polynomial in the place, but for
what is bounded (`engine.interpolation.proof.pieces`): on such a cell it is Σ B_ab c_ab with
Bernstein's B_ab ≥ 0 of sum 1. Convex functions of it are at most the largest of their values at the
control values c_ab. With x ≤ Σ B x_ab and g ≤ Σ B g_ab, and x ≤ x⁺, g ≥ g⁻ ≥ 0 on the cell,

    x g ≤ x⁺ g + g⁻ x − x⁺ g⁻ ≤ max_ab (x⁺ g_ab + g⁻ x_ab) − x⁺ g⁻,

since (x⁺ − x) (g − g⁻) ≥ 0. What an enclosure is too large by falls with the square of the cell.
"""

from math import inf
from typing import Generic, NamedTuple

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, ratio
from engine.interpolation.enclosing.pieces import number
from engine.maps import Enclosures

LARGEST_LOGARITHM = 300.0  # what is beyond overflows: nothing is proven there


class Patch(NamedTuple, Generic[number]):
    """A quantity on cells.

    Parameters
    ----------
    controls : float64 or complex128, shape (c, d, b)
        Along time, and along the place.
    error : float64, shape (c,)
        By how much the truth may be elsewhere.
    """

    controls: npt.NDArray[number]
    error: Floats

    @property
    def highest(self) -> Floats:
        """Upper bounds of the absolute value, as control values."""
        sizes: Floats = np.abs(self.controls) + self.error[:, None, None]
        return sizes

    def elevated(self) -> "Patch[number]":
        """Return the same, linear or quadratic along the place, as a quadratic."""
        if self.controls.shape[2] > 2:
            return self
        first, last = self.controls[..., :1], self.controls[..., -1:]
        return Patch(np.concatenate([first, (first + last) / 2, last], axis=2), self.error)

    def plus(self, other: "Patch[number]") -> "Patch[number]":
        """Return the sum with something linear in time."""
        raised = other.in_time(self.controls.shape[1])
        return Patch(self.controls + raised.controls, self.error + raised.error)

    def in_time(self, count: int) -> "Patch[number]":
        """Return the same, linear in time, with so many control values along it."""
        share = np.linspace(0.0, 1.0, count)[:, None]
        first, last = self.controls[:, :1], self.controls[:, -1:]
        return Patch((1.0 - share) * first + share * last, self.error)

    def times(self, factor: float) -> "Patch[number]":
        """Return a multiple."""
        return Patch(factor * self.controls, abs(factor) * self.error)

    def corners(self) -> "Patch[number]":
        """Return the values at the cells' corners, which are attained, as cells (4c,)."""
        at_corners = self.controls[:, [0, -1]][:, :, [0, -1]]
        return Patch(at_corners.reshape(-1, 1, 1), np.zeros(at_corners.size))


class Changes(NamedTuple):
    """What becomes of f_z and conj(f_z̄) after they were blended, as logarithms on cells.

    Parameters
    ----------
    correction : Patch
        Re h (`engine.interpolation.periods`).
    rho : Patch
        ln ρ, by which conj(f_z̄) is scaled.
    factor : Patch
        ln |ρ + (1 − ρ) e^d|, by which f_z is multiplied where there is a d.
    """

    correction: Patch[np.float64]
    rho: Patch[np.float64]
    factor: Patch[np.float64]

    def corners(self) -> "Changes":
        """Return the values at the cells' corners, which are attained, as cells (4c,)."""
        return Changes(*(patch.corners() for patch in self))


def _range(patch: Patch[np.float64]) -> Floats:
    """Return between which a quantity is, float64 (2, c)."""
    return np.stack([_least(patch.controls) - patch.error, _largest(patch.controls) + patch.error])


def linear(conformal: Patch[np.complex128], anticonformal: Patch[np.complex128]) -> Enclosures:
    """Enclose of f_z and conj(f_z̄)."""
    a = along_mean(conformal.controls, (1, 2)) - conformal.error[:, None, None]  # at least |f_z|
    b = anticonformal.highest
    return Enclosures(
        k=_largest(ratio(b, a)),
        sigma_a=_largest(conformal.highest + b),
        sigma_b=_least(a - b),
    )


def exponential(
    log_fz: Patch[np.float64],
    log_factor: Patch[np.float64],
    log_ratio: Patch[np.float64],
    second: Patch[np.complex128],
) -> Enclosures:
    """Enclose of ln |f_z|, with |f_z̄| as the absolute value of something times an exponential.

    Parameters
    ----------
    log_fz : Patch
    log_factor : Patch
        |f_z̄| is the exponential of it times |second|.
    log_ratio : Patch
        The same, less ln |f_z|: given by itself, since errors cancel.
    second : Patch
    """
    size = second.elevated().highest
    most = _largest(size)[:, None, None]

    def product(logarithm: Patch[np.float64]) -> Floats:
        # At most |second| exp(logarithm).
        values, error = _bounded(logarithm.elevated())
        grown = np.exp(values + error)
        lowest = np.exp(_least(values - error))[:, None, None]
        bent: Floats = most * grown + lowest * (size - most)
        return bent

    b = product(log_factor)
    log_a, error = _bounded(log_fz.elevated())
    return Enclosures(
        k=_largest(product(log_ratio)),
        sigma_a=_largest(np.exp(log_a + error) + b),
        sigma_b=_least(_tangent(log_a, error) - b),
    )


def from_metric(trace: Patch[np.float64], eta: Patch[np.complex128]) -> Enclosures:
    """Enclose of 𝒜 and η, Equations (10) to (12): 𝒜 ± 2 |η| = σ² and |η| / 𝒜 = k / (1 + k²)."""
    y, error = eta.highest, trace.error[:, None, None]
    share = _largest(ratio(y, trace.controls - error))
    return Enclosures(
        k=k_of(share),
        sigma_a=np.sqrt(_largest(trace.controls + error + 2 * y)),
        sigma_b=np.sqrt(np.maximum(_least(trace.controls - error - 2 * y), 0.0)),
    )


def changed_metric(
    trace: Patch[np.float64], eta: Patch[np.complex128], changes: Changes
) -> Enclosures:
    """Enclose of 𝒜 and η, where f_z and conj(f_z̄) are changed further."""
    error = trace.error[:, None, None]
    least, most = _least(trace.controls - error), _largest(trace.controls + error)
    size_most, size_least = _largest(eta.highest), _size_least(eta)
    # The larger root of Equation (13), and |η| over it.
    a_least, a_most = (
        np.sqrt((t + np.sqrt(np.maximum(t * t - 4 * y * y, 0.0))) / 2)
        for t, y in ((least, size_most), (most, size_least))
    )
    b = ratio(size_most, np.where(least >= 2 * size_most, a_least, 0.0))
    log, log_rho, log_factor = map(_range, changes)
    grown, shrunk = np.exp(log), np.exp(log_rho[1] - log)
    least_factor, most_factor = np.exp(log_factor)
    return Enclosures(
        k=ratio(b, a_least) * shrunk[0] / (grown[0] * least_factor),
        sigma_a=(a_most * grown * most_factor + b * shrunk).max(axis=0),
        sigma_b=a_least * grown[0] * least_factor - b * shrunk[0],
    )


def k_of(share: Floats) -> Floats:
    """Return k of |η| / 𝒜 = k / (1 + k²), infinite from 1/2 on."""
    inside = share < 0.5
    root = np.sqrt(1.0 - 4.0 * np.where(inside, share, 0.0) ** 2)
    k: Floats = np.where(inside, 2.0 * share / (1.0 + root), inf)
    return k


def along_mean(controls: Complexes, axes: int | tuple[int, ...]) -> Floats:
    """Return components along the mean of control values: the least is at most any |value|."""
    mean = controls.mean(axis=axes, keepdims=True)
    size = np.abs(mean)
    components: Floats = (
        controls * np.divide(mean.conj(), size, out=np.zeros_like(mean), where=size > 0)
    ).real
    return components


def _bounded(log_modulus: Patch[np.float64]) -> tuple[Floats, Floats]:
    """Return control values and errors of a logarithm that do not overflow."""
    error = np.minimum(log_modulus.error, LARGEST_LOGARITHM)[:, None, None]
    log_a: Floats = np.clip(log_modulus.controls, -LARGEST_LOGARITHM, LARGEST_LOGARITHM)
    return log_a, error


def _tangent(log_a: Floats, error: Floats) -> Floats:
    """Return control values of something that is at most |f_z|: its tangent in the logarithm."""
    middle = log_a.mean(axis=(1, 2), keepdims=True)
    below: Floats = np.exp(middle) * (1.0 + log_a - error - middle)
    return below


def _largest(values: Floats) -> Floats:
    found: Floats = values.max(axis=(1, 2))
    return found


def _least(values: Floats) -> Floats:
    found: Floats = values.min(axis=(1, 2))
    return found


def _size_least(eta: Patch[np.complex128]) -> Floats:
    """Return what the absolute value is at least."""
    return np.maximum(_least(along_mean(eta.controls, (1, 2))) - eta.error, 0.0)
