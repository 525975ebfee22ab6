"""Enclosures of the distortion on a piece of the boundary during a piece of time.

A blended quantity is a polynomial in time, and along a piece a polynomial in the place, up to a
bounded error (`engine.interpolation.enclosures.pieces`). On such a cell it is Σ B_ab c_ab with
Bernstein polynomials B_ab ≥ 0 of sum 1. A convex function of it is at most the largest of its
values at the control values c_ab. With x ≤ Σ B x_ab and g ≤ Σ B g_ab, and x ≤ x⁺, g ≥ g⁻ ≥ 0 on the
cell,

    x g ≤ x⁺ g + g⁻ x − x⁺ g⁻ ≤ max_ab (x⁺ g_ab + g⁻ x_ab) − x⁺ g⁻,

since (x⁺ − x) (g − g⁻) ≥ 0. The excess of an enclosure falls with the square of the cell's size.
"""

from collections.abc import Callable
from math import inf
from typing import Generic, NamedTuple

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, ratio
from engine.interpolation.enclosures.pieces import number
from engine.maps import Enclosures

LARGEST_LOGARITHM = 300.0  # larger logarithms overflow; nothing is proven there


class BernsteinPatch(NamedTuple, Generic[number]):
    """A quantity on cells.

    `controls` are float64 or complex128 (c, d, b), along time and along the place. `error` (c,)
    bounds the distance of the quantity from its polynomial.
    """

    controls: npt.NDArray[number]
    error: Floats

    @property
    def highest(self) -> Floats:
        """Upper bounds of the absolute value, as control values."""
        sizes: Floats = np.abs(self.controls) + self.error[:, None, None]
        return sizes

    def elevated(self) -> "BernsteinPatch[number]":
        """Return the patch, linear or quadratic along the place, as a quadratic."""
        if self.controls.shape[2] > 2:
            return self
        first, last = self.controls[..., :1], self.controls[..., -1:]
        return BernsteinPatch(np.concatenate([first, (first + last) / 2, last], axis=2), self.error)

    def plus(self, other: "BernsteinPatch[number]") -> "BernsteinPatch[number]":
        """Return the sum with a patch that is linear in time."""
        raised = other.in_time(self.controls.shape[1])
        return BernsteinPatch(self.controls + raised.controls, self.error + raised.error)

    def in_time(self, count: int) -> "BernsteinPatch[number]":
        """Return a patch that is linear in time, with `count` control values along time."""
        share = np.linspace(0.0, 1.0, count)[:, None]
        first, last = self.controls[:, :1], self.controls[:, -1:]
        return BernsteinPatch((1.0 - share) * first + share * last, self.error)

    def times(self, factor: float) -> "BernsteinPatch[number]":
        return BernsteinPatch(factor * self.controls, abs(factor) * self.error)

    def corners(self) -> "BernsteinPatch[number]":
        """Return the values at the cells' corners, which are attained, as cells (4c,)."""
        at_corners = self.controls[:, [0, -1]][:, :, [0, -1]]
        return BernsteinPatch(at_corners.reshape(-1, 1, 1), np.zeros(at_corners.size))


class BlendChanges(NamedTuple):
    """Later changes of the blended f_z and conj(f_z̄), as logarithms on cells.

    `correction` is Re h (`engine.interpolation.added`). `rho` is ln ρ, which scales conj(f_z̄).
    `factor` is ln |ρ + (1 − ρ) e^d|, which scales f_z around holes.
    """

    correction: BernsteinPatch[np.float64]
    rho: BernsteinPatch[np.float64]
    factor: BernsteinPatch[np.float64]

    def corners(self) -> "BlendChanges":
        """Return the values at the cells' corners, which are attained, as cells (4c,)."""
        return BlendChanges(*(patch.corners() for patch in self))


def enclose_linear(
    conformal: BernsteinPatch[np.complex128], anticonformal: BernsteinPatch[np.complex128]
) -> Enclosures:
    """Enclose the distortion, given f_z and conj(f_z̄)."""
    a = (
        project_on_mean(conformal.controls, (1, 2)) - conformal.error[:, None, None]
    )  # at least |f_z|
    b = anticonformal.highest
    return Enclosures(
        k=_largest(ratio(b, a)),
        sigma_a=_largest(conformal.highest + b),
        sigma_b=_least(a - b),
    )


def enclose_exponential(
    log_fz: BernsteinPatch[np.float64],
    log_factor: BernsteinPatch[np.float64],
    log_ratio: BernsteinPatch[np.float64],
    second: BernsteinPatch[np.complex128],
) -> Enclosures:
    """Enclose the distortion, given ln |f_z|; |f_z̄| is exp(log_factor) |second|.

    `log_ratio` is log_factor − ln |f_z|. It is a separate argument, since errors cancel in it.
    """
    size = second.elevated().highest
    most = _largest(size)[:, None, None]

    def product(logarithm: BernsteinPatch[np.float64]) -> Floats:
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


def enclose_metric(
    trace: BernsteinPatch[np.float64], eta: BernsteinPatch[np.complex128]
) -> Enclosures:
    """Enclose by 𝒜 and η, Equations (10) to (12): 𝒜 ± 2 |η| = σ² and |η| / 𝒜 = k / (1 + k²)."""
    y, error = eta.highest, trace.error[:, None, None]
    share = _largest(ratio(y, trace.controls - error))
    return Enclosures(
        k=k_of_ratio(share),
        sigma_a=np.sqrt(_largest(trace.controls + error + 2 * y)),
        sigma_b=np.sqrt(np.maximum(_least(trace.controls - error - 2 * y), 0.0)),
    )


def enclose_changed_metric(
    trace: BernsteinPatch[np.float64], eta: BernsteinPatch[np.complex128], changes: BlendChanges
) -> Enclosures:
    """Enclose the distortion, given 𝒜 and η and later changes of f_z and conj(f_z̄).

    Notes
    -----
    With u = ln (|η| / 𝒜) before the changes, and its k from k / (1 + k²) = e^u,

        ln |f_z| = ½ ln 𝒜 − ½ ln (1 + k²),    ln |f_z̄| = ln k + ln |f_z|,

    where ln k, ½ ln (1 + k²) and their difference are convex in u and rise with it. Chords and
    tangents, linear in 𝒜 and |η|, bound all of these from above and below. Their bounds are
    therefore Σ B of their values at the control values.
    """
    h, log_rho, factor = (each.elevated() for each in changes)
    error = trace.error[:, None, None]
    least, most = trace.controls - error, trace.controls + error
    size, size_least = eta.highest, project_on_mean(eta.controls, (1, 2)) - eta.error[:, None, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        log_least, log_most = _chord(np.log, least, most), _tangent_of_log(most)
        highest = _tangent_of_log(size) - log_least
        ends = _extremes(highest)
        k = k_of_ratio(np.exp(ends))
        log_k, half = np.log(k), 0.5 * np.log1p(k * k)
        # Bounds of ln k, of ½ ln (1 + k²), and of their difference.
        bounds = [_between(ends, at, highest) for at in (log_k, half, log_k - half)]
        lowest = _chord(np.log, size_least, size) - log_most
        place = lowest.mean(axis=(1, 2), keepdims=True)
        there = k_of_ratio(np.exp(place))
        known = 0.5 * np.log1p(there * there) + there**2 / (1 - there**2) * (lowest - place)
        known = np.where(size_least.min(axis=(1, 2), keepdims=True) > 0, known, 0.0)
    grown, shrunk = h.plus(factor), log_rho.plus(h.times(-1.0))
    ratio_of = shrunk.plus(grown.times(-1.0))

    def changed(values: Floats, change: BernsteinPatch[np.float64], sign: int) -> Floats:
        raised = change.in_time(values.shape[1])
        total: Floats = values + raised.controls + sign * raised.error[:, None, None]
        return total

    b = np.exp(changed(bounds[2] + log_most / 2, shrunk, 1))
    a_most = np.exp(changed(log_most / 2 - known, grown, 1))
    a_least = changed(log_least / 2 - bounds[1], grown, -1)
    clear = (_least(least) > 0) & (k[1, :, 0, 0] < inf)
    return Enclosures(
        k=np.where(clear, np.exp(_largest(changed(bounds[0], ratio_of, 1))), inf),
        sigma_a=np.where(clear, _largest(a_most + b), inf),
        sigma_b=np.where(clear, _least(_tangent(a_least, error * 0.0) - b), -inf),
    )


def _extremes(values: Floats) -> Floats:
    """Return the least and the largest control value, float64 (2, c, 1, 1)."""
    return np.stack([each(values, axis=(1, 2), keepdims=True) for each in (np.min, np.max)])


def _between(ends: Floats, at_ends: Floats, places: Floats) -> Floats:
    """Return the chord from one end (2, c, 1, 1) to the other at places (c, d, b)."""
    length = ends[1] - ends[0]
    share = np.where(length > 0, (places - ends[0]) / np.where(length > 0, length, 1.0), 0.0)
    chord: Floats = at_ends[0] + share * (at_ends[1] - at_ends[0])
    return np.where(length > 0, chord, at_ends.max(axis=0))


def _chord(function: Callable[[Floats], Floats], least: Floats, most: Floats) -> Floats:
    """Return the chord of a function over the whole range, at the lower bounds `least`."""
    ends = np.stack([_extremes(least)[0], _extremes(most)[1]])
    return _between(ends, function(ends), least)


def _tangent_of_log(values: Floats) -> Floats:
    """Return a tangent of the logarithm: an upper bound, linear in the values."""
    place = np.maximum(values.mean(axis=(1, 2), keepdims=True), np.finfo(np.float64).tiny)
    tangent: Floats = np.log(place) + (values - place) / place
    return tangent


def k_of_ratio(share: Floats) -> Floats:
    """Return k with |η| / 𝒜 = k / (1 + k²); infinite for ratios from 1/2 on."""
    inside = share < 0.5
    root = np.sqrt(1.0 - 4.0 * np.where(inside, share, 0.0) ** 2)
    k: Floats = np.where(inside, 2.0 * share / (1.0 + root), inf)
    return k


def project_on_mean(controls: Complexes, axes: int | tuple[int, ...]) -> Floats:
    """Return components along the mean of control values: the least is at most any |value|."""
    mean = controls.mean(axis=axes, keepdims=True)
    size = np.abs(mean)
    components: Floats = (
        controls * np.divide(mean.conj(), size, out=np.zeros_like(mean), where=size > 0)
    ).real
    return components


def _bounded(log_modulus: BernsteinPatch[np.float64]) -> tuple[Floats, Floats]:
    """Return control values and errors of a logarithm, clipped to avoid overflow."""
    error = np.minimum(log_modulus.error, LARGEST_LOGARITHM)[:, None, None]
    log_a: Floats = np.clip(log_modulus.controls, -LARGEST_LOGARITHM, LARGEST_LOGARITHM)
    return log_a, error


def _tangent(log_a: Floats, error: Floats) -> Floats:
    """Return control values of a lower bound of |f_z|: the tangent of exp at the logarithm."""
    middle = log_a.mean(axis=(1, 2), keepdims=True)
    below: Floats = np.exp(middle) * (1.0 + log_a - error - middle)
    return below


def _largest(values: Floats) -> Floats:
    found: Floats = values.max(axis=(1, 2))
    return found


def _least(values: Floats) -> Floats:
    found: Floats = values.min(axis=(1, 2))
    return found
