"""A ρ that is C^∞ in time: Property 4 for scaled η, which Section 5.5 leaves to future work."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Self

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from engine.arrays import Floats, Indices, freeze, ragged_indices

# Time is stretched to u, t = 1 / (1 + exp(−STRETCH sinh(u / STRETCH))). A window of constant width
# in u therefore narrows towards both keyframes, where ρ must be 1.
STRETCH = 2.0
SPACING = 1 / 192
FARTHEST = 7.125  # for larger |u| the time equals that of a keyframe, to rounding
HALF_WINDOW = 3  # samples on each side of a window's middle
# The exact ρ is first evaluated at every COARSEST-th sample and halfway between two of them. Away
# from kinks the interpolation predicts the middle to `SMOOTH`; the other samples are interpolated.
COARSEST = 8
SMOOTH = 3e-7
MIDDLE = (3, -25, 150, 150, -25, 3)  # over 256, of six samples: the polynomial through them
# Factor on the difference from the exact ρ, which is evaluated at the samples only.
CAUTION = 1.25
ROUNDING = 2e-7
STRIPS = 128  # per sample; upper and lower bounds of ρ are constant on a strip


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SmoothedRho:
    """A C^∞ function of time between two keyframes, nowhere above the exact ρ, and 1 at both ends.

    At each time ln ρ is the value of a parabola fitted to the samples of a window, weighted by a
    C^∞ bump. Where the exact ρ is smooth the fit reproduces it to some 1e-6; at a kink it rounds
    the corner. The excess of the fit near a time is smoothed likewise and subtracted.

    Attributes
    ----------
    logarithms : float64, shape (s,)
        ln ρ of the exact scaling at the samples of u, and at some beyond both ends.
    excess : float64, shape (s,)
        Largest excess of the fit over the samples within a window around each sample.
    """

    logarithms: Floats
    excess: Floats

    @classmethod
    def of(cls, sharp: Callable[[Floats], Floats]) -> Self:
        """Sample an exact ρ and fit it."""
        count = round(2 * FARTHEST / SPACING) + 1
        u = np.linspace(-FARTHEST, FARTHEST, count)
        logarithms = _sampled(lambda at: np.log(sharp(unstretch_times(at))), u)
        fitted = _fits(logarithms, 0.0), _fits(logarithms, 0.5)
        padded = np.pad(logarithms, (1, 2))
        between = (9 * (padded[1:-2] + padded[2:-1]) - padded[:-3] - padded[3:]) / 16
        above = np.maximum(fitted[0] - logarithms, fitted[1] - between)
        above = np.where(above > 0.0, CAUTION * above + ROUNDING, 0.0)
        around = HALF_WINDOW + 1
        windows = sliding_window_view(np.pad(above, around), 2 * around + 1)
        # Beyond the ends the time is that of a keyframe, and ln ρ is 0.
        beyond = HALF_WINDOW + 1
        return cls(
            logarithms=freeze(np.pad(logarithms, beyond)),
            excess=freeze(np.pad(windows.max(axis=1), beyond)),
        )

    @property
    def least(self) -> float:
        """Lower bound of ρ."""
        return math.exp(float((self.logarithms - self.excess).min()))

    def __call__(self, time: float) -> float:
        """Return ρ in (0, 1] at a time in [0, 1]."""
        return float(self.at(np.array([time]))[0])

    def at(self, times: Floats) -> Floats:
        place = _places(times)
        nearest = np.rint(place)
        fit, mean = _weights(place - nearest)
        window = nearest.astype(np.intp)[:, None] + np.arange(1, 2 * HALF_WINDOW + 2)
        logarithms = (fit * self.logarithms[window]).sum(axis=1)
        logarithms -= (mean * self.excess[window]).sum(axis=1)
        rho: Floats = np.exp(np.minimum(logarithms, 0.0))
        rho[(times <= 0.0) | (times >= 1.0)] = 1.0
        return rho

    def enclosures(self) -> "RhoEnclosures":
        """Return bounds of ρ on pieces of time."""
        fits, means = _weights((np.arange(STRIPS) + 0.5) / STRIPS - 0.5)
        width = 2 * HALF_WINDOW + 1
        windows = sliding_window_view(self.logarithms, width)
        excess = sliding_window_view(self.excess, width)
        # The weights sum to 1, so only the range of the values matters. A fit reproduces linear
        # functions, so for fits only the range of the nonlinear part matters.
        samples = np.arange(-HALF_WINDOW, HALF_WINDOW + 1)
        slope = windows @ samples / (samples @ samples)
        bent, of_excess = _steepness()
        reach = np.abs(slope) + bent * np.ptp(windows - slope[:, None] * samples, axis=1)
        reach += of_excess * np.ptp(excess, axis=1)
        middle = windows @ fits.T - excess @ means.T
        margin = (reach / (2 * STRIPS))[:, None]
        count = len(windows) * STRIPS
        return RhoEnclosures(
            scaling=self,
            lowest=freeze(np.minimum((middle - margin).ravel(), 0.0)),
            highest=freeze(np.minimum((middle + margin).ravel(), 0.0)),
            times=freeze(
                unstretch_times(((np.arange(count + 1)) / STRIPS - 1.5) * SPACING - FARTHEST)
            ),
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RhoEnclosures:
    """Bounds of ln ρ on strips of the stretched time.

    `lowest` and `highest` (s,) start half a sample before the middle of the first window. `times`
    (s + 1,) are the ends of the strips.
    """

    scaling: SmoothedRho
    lowest: Floats
    highest: Floats
    times: Floats

    def linear_enclosures(self, starts: Floats, ends: Floats) -> tuple[Floats, Floats]:
        """Return ln ρ at both ends of pieces of time, (c, 2), and the chords' errors, (c,)."""
        pairs, which = np.unique(np.stack([starts, ends]), axis=1, return_inverse=True)
        values = np.log(np.stack([self.scaling.at(times) for times in pairs], axis=1))
        # One strip more on either side, against rounding.
        first = np.maximum(self._strip(pairs[0]) - 1, 0)
        counts = np.minimum(self._strip(pairs[1]) + 2, len(self.highest)) - first
        owner, place = ragged_indices(counts)
        strip = first[owner] + place
        beside = np.clip(self.times[[strip, strip + 1]], pairs[0][owner], pairs[1][owner])
        length = pairs[1] - pairs[0]
        share = (beside - pairs[0][owner]) / np.where(length > 0, length, 1.0)[owner]
        chord = values[owner, 0] + share * np.diff(values, axis=1)[owner, 0]
        above = self.highest[strip] - chord.min(axis=0)
        off = np.maximum(above, chord.max(axis=0) - self.lowest[strip])
        errors = np.maximum(np.maximum.reduceat(off, counts.cumsum() - counts), 0.0)
        # A single time has no points between its ends.
        errors = np.where(length > 0, errors, 0.0)
        return values[which], errors[which]

    def _strip(self, times: Floats) -> Indices:
        return np.asarray((_places(times) + 1.5) * STRIPS, dtype=np.intp)


def unstretch_times(u: Floats) -> Floats:
    """Return the times in (0, 1), given stretched times."""
    times: Floats = 1.0 / (1.0 + np.exp(-STRETCH * np.sinh(u / STRETCH)))
    return times


def _places(times: Floats) -> Floats:
    """Return times in [0, 1] as fractional indices of samples, at most one beyond the ends."""
    with np.errstate(divide="ignore"):
        u = STRETCH * np.arcsinh((np.log(times) - np.log1p(-times)) / STRETCH)
    places: Floats = np.clip((u + FARTHEST) / SPACING, -1.0, round(2 * FARTHEST / SPACING) + 1.0)
    return places


def _sampled(function: Callable[[Floats], Floats], u: Floats) -> Floats:
    """Return the values of a function, 0 beyond both ends, at equidistant places (s,).

    Most values are interpolated where the function is smooth.
    """
    values, rough = np.empty(len(u)), np.ones(len(u), np.bool_)
    step = COARSEST
    values[::step] = function(u[::step])
    while step > 1:
        stencils = sliding_window_view(np.pad(values[::step], 2), len(MIDDLE))
        between = np.arange(step // 2, len(u), step)
        values[between] = stencils @ np.divide(MIDDLE, 256)
        looked = between[rough[between]]
        found = function(u[looked])
        wrong = looked[np.abs(found - values[looked]) > SMOOTH]
        values[looked] = found
        # A kink is within half a step of a wrong sample, and the next stencils reach 5/4 steps.
        near = wrong[:, None] + np.arange(-2 * step, 2 * step + 1)
        rough[:] = False
        rough[np.clip(near, 0, len(u) - 1)] = True
        step //= 2
    return values


def _weights(offsets: Floats) -> tuple[Floats, Floats]:
    """Return the weights of a window's samples at offsets (t,) from its middle.

    The first weights give the fitted parabola's value, the second the mean. Each has the shape
    (t, 2 HALF_WINDOW + 1) and sum 1.
    """
    samples = np.arange(-HALF_WINDOW, HALF_WINDOW + 1)
    place = (samples - offsets[:, None]) / (HALF_WINDOW + 0.5)
    squared = place * place
    bump = np.exp(-1.0 / np.maximum(1.0 - squared, 1e-3))
    # The first row of the inverse of the parabola's normal equations, by its cofactors.
    powers = bump * np.array([np.ones_like(place), place, squared])
    m0, m1, m2 = powers.sum(axis=2)
    m3, m4 = (squared * powers[1:]).sum(axis=2)
    cofactors = np.array([m2 * m4 - m3 * m3, m2 * m3 - m1 * m4, m1 * m3 - m2 * m2])
    fit = (cofactors[..., None] * powers).sum(axis=0)
    fit /= fit.sum(axis=1, keepdims=True)
    return fit, bump / m0[:, None]


@cache
def _steepness() -> tuple[float, float]:
    """Return the largest slopes of a fit and a mean by the offset, for values of range 1."""
    fits, means = _weights(np.linspace(-0.5, 0.5, 1025))
    # The weights are smooth; the margin covers steeper places between the samples.
    return tuple(
        1.05 * float(np.abs(np.diff(each, axis=0)).sum(axis=1).max()) * 1024 / 2
        for each in (fits, means)
    )  # type: ignore[return-value]


def _fits(values: Floats, offset: float) -> Floats:
    """Return the fit at an offset from each sample, like `values`; they are 0 beyond the ends."""
    windows = sliding_window_view(np.pad(values, HALF_WINDOW), 2 * HALF_WINDOW + 1)
    fits: Floats = windows @ _weights(np.array([offset]))[0][0]
    return fits
