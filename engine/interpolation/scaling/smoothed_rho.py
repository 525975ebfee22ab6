"""A ρ that is C^∞ in time: Property 4 for scaled η (Section 5.5 leaves that to others)."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Self

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from engine.arrays import Floats, Indices, freeze, ragged_indices

# Time is stretched to u, t = 1 / (1 + exp(−STRETCH sinh(u / STRETCH))), so that a window of
# constant width in u narrows towards both keyframes, where ρ has to be 1.
STRETCH = 2.0
SPACING = 1 / 192
FARTHEST = 7.125  # |u| from which on time is a keyframe's, to rounding
HALF_WINDOW = 3  # samples on each side from which the value at a time is taken
# Every so many samples the sharp ρ is looked at first, and in the middle between two of them. What
# is between these is interpolated where that would have told the middle to `SMOOTH`: but around
# its kinks.
COARSEST = 8
SMOOTH = 3e-7
MIDDLE = (3, -25, 150, 150, -25, 3)  # over 256, of six samples: the polynomial through them
# What the difference from the sharp ρ is enlarged by, since it is seen at the samples only.
CAUTION = 1.25
ROUNDING = 2e-7
STRIPS = 128  # of each sample's surroundings, on which ρ is bounded from above


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SmoothedRho:
    """A C^∞ function of time between two keyframes, nowhere above the sharp ρ, and 1 at both.

    ln ρ is fitted at each time by the parabola through the samples of a window, weighted by a C^∞
    bump. Where the sharp ρ is smooth the fit returns it to some 1e-6; around a kink it cuts the
    corner. What it would be too high by near a time is taken off, likewise smoothed.

    Parameters
    ----------
    logarithms : float64, shape (s,)
        ln ρ of the sharp scaling at the samples of u, and some beyond both ends.
    excess : float64, shape (s,)
        The most by which the fit is above them within a window around each.
    """

    logarithms: Floats
    excess: Floats

    @classmethod
    def of(cls, sharp: Callable[[Floats], Floats]) -> Self:
        """Sample a sharp ρ and fit it."""
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
        # Beyond the ends time is a keyframe's and ln ρ is 0.
        beyond = HALF_WINDOW + 1
        return cls(
            logarithms=freeze(np.pad(logarithms, beyond)),
            excess=freeze(np.pad(windows.max(axis=1), beyond)),
        )

    @property
    def least(self) -> float:
        """The smallest ρ that it may have."""
        return math.exp(float((self.logarithms - self.excess).min()))

    def __call__(self, time: float) -> float:
        """Return ρ in (0, 1] at a time in [0, 1]."""
        return float(self.at(np.array([time]))[0])

    def at(self, times: Floats) -> Floats:
        """Return ρ at times (t,)."""
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
        """Return what is proven of ρ on pieces of time."""
        fits, means = _weights((np.arange(STRIPS) + 0.5) / STRIPS - 0.5)
        width = 2 * HALF_WINDOW + 1
        windows = sliding_window_view(self.logarithms, width)
        excess = sliding_window_view(self.excess, width)
        # The weights sum to 1, so that of the values only their range counts; and as a fit follows
        # what is linear, only that of what is not.
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

    Parameters
    ----------
    scaling : SmoothedRho
    lowest, highest : float64, shape (s,)
        From half a sample before the first window's middle on.
    times : float64, shape (s + 1,)
        The ends of the strips.
    """

    scaling: SmoothedRho
    lowest: Floats
    highest: Floats
    times: Floats

    def linear_enclosures(self, starts: Floats, ends: Floats) -> tuple[Floats, Floats]:
        """Return ln ρ at both ends of pieces of time (c,), and by how much it may be off the chord.

        Returns
        -------
        float64, shape (c, 2)
        float64, shape (c,)
        """
        pairs, which = np.unique(np.stack([starts, ends]), axis=1, return_inverse=True)
        values = np.log(np.stack([self.scaling.at(times) for times in pairs], axis=1))
        # By the strips before and behind, against rounding.
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
        # At a single time nothing lies between the ends.
        errors = np.where(length > 0, errors, 0.0)
        return values[which], errors[which]

    def _strip(self, times: Floats) -> Indices:
        return np.asarray((_places(times) + 1.5) * STRIPS, dtype=np.intp)


def unstretch_times(u: Floats) -> Floats:
    """Return the times in (0, 1) of stretched ones."""
    times: Floats = 1.0 / (1.0 + np.exp(-STRETCH * np.sinh(u / STRETCH)))
    return times


def _places(times: Floats) -> Floats:
    """Return where times in [0, 1] are among the samples, at most one beyond the ends."""
    with np.errstate(divide="ignore"):
        u = STRETCH * np.arcsinh((np.log(times) - np.log1p(-times)) / STRETCH)
    places: Floats = np.clip((u + FARTHEST) / SPACING, -1.0, round(2 * FARTHEST / SPACING) + 1.0)
    return places


def _sampled(function: Callable[[Floats], Floats], u: Floats) -> Floats:
    """Return the values of a function, 0 beyond both ends, at equidistant places (s,).

    Where it is smooth most of them are interpolated.
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
        # A kink is within half a step of one that is wrong, and the next stencils reach 5/4 steps.
        near = wrong[:, None] + np.arange(-2 * step, 2 * step + 1)
        rough[:] = False
        rough[np.clip(near, 0, len(u) - 1)] = True
        step //= 2
    return values


def _weights(offsets: Floats) -> tuple[Floats, Floats]:
    """Return by how much each sample of a window counts at offsets (t,) from its middle.

    Returns
    -------
    fit, mean : float64, shape (t, 2 HALF_WINDOW + 1)
        Of the value of the fitted parabola, and of the mean; both sum to 1.
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
    """Return how fast a fit and a mean may change with the offset, over the range of the values."""
    fits, means = _weights(np.linspace(-0.5, 0.5, 1025))
    # The weights are smooth; the margin covers what their steepest place is off the samples.
    return tuple(
        1.05 * float(np.abs(np.diff(each, axis=0)).sum(axis=1).max()) * 1024 / 2
        for each in (fits, means)
    )  # type: ignore[return-value]


def _fits(values: Floats, offset: float) -> Floats:
    """Return the fit at an offset from each sample, like `values`; they are 0 beyond the ends."""
    windows = sliding_window_view(np.pad(values, HALF_WINDOW), 2 * HALF_WINDOW + 1)
    fits: Floats = windows @ _weights(np.array([offset]))[0][0]
    return fits
