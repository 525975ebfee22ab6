"""A ρ that is C^∞ in time: Property 4 for scaled η (Section 5.5 leaves that to others)."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from operator import mul
from typing import Self

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from engine.arrays import Floats, Indices, freeze

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
STRIPS = 32  # of each sample's surroundings, on which ρ is bounded from above


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scaling:
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
        logarithms = _sampled(lambda at: np.log(sharp(time_of(at))), u)
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

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return self.logarithms.nbytes + self.excess.nbytes

    def __call__(self, time: float) -> float:
        """Return ρ in (0, 1] at a time in [0, 1]."""
        if not 0.0 < time < 1.0:
            return 1.0
        u = STRETCH * math.asinh(math.log(time / (1.0 - time)) / STRETCH)
        place = min(max((u + FARTHEST) / SPACING, -1.0), round(2 * FARTHEST / SPACING) + 1.0)
        nearest = round(place)
        fit, mean = _weights(place - nearest)
        window = slice(nearest + 1, nearest + 1 + 2 * HALF_WINDOW + 1)
        logarithm = _dot(fit, self.logarithms[window].tolist())
        logarithm -= _dot(mean, self.excess[window].tolist())
        return math.exp(min(logarithm, 0.0))

    def enclosures(self) -> "ScalingEnclosures":
        """Return what is proven of ρ on pieces of time."""
        offsets = (np.arange(STRIPS) + 0.5) / STRIPS - 0.5
        fits, means = (np.array(each) for each in zip(*map(_weights, offsets), strict=True))
        width = 2 * HALF_WINDOW + 1
        windows = sliding_window_view(self.logarithms, width)
        excess = sliding_window_view(self.excess, width)
        # The weights sum to 1, so that of the values only their range counts.
        reach = [
            steepness * np.ptp(each, axis=1)
            for steepness, each in zip(_steepness(), (windows, excess), strict=True)
        ]
        middle = windows @ fits.T - excess @ means.T
        margin = ((reach[0] + reach[1]) / (2 * STRIPS))[:, None]
        return ScalingEnclosures(
            lowest=freeze(np.minimum((middle - margin).ravel(), 0.0)),
            highest=freeze(np.minimum((middle + margin).ravel(), 0.0)),
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ScalingEnclosures:
    """Bounds of ln ρ on strips of the stretched time.

    Parameters
    ----------
    lowest, highest : float64, shape (s,)
        From half a sample before the first window's middle on.
    """

    lowest: Floats
    highest: Floats

    def on(self, starts: Floats, ends: Floats) -> tuple[Floats, Floats]:
        """Return between which ρ is from one time to another, (c,) each."""
        pairs, which = np.unique(np.stack([starts, ends]), axis=1, return_inverse=True)
        # By the strips before and behind, against rounding.
        first = np.maximum(self._strip(pairs[0]) - 1, 0)
        last = np.minimum(self._strip(pairs[1]) + 2, len(self.highest) - 1)
        bounds = np.stack([first, last], axis=1).ravel()
        least = np.exp(np.minimum.reduceat(self.lowest, bounds)[::2])
        most = np.exp(np.maximum.reduceat(self.highest, bounds)[::2])
        most[(pairs[0] <= 0.0) | (pairs[1] >= 1.0)] = 1.0
        return least[which], most[which]

    def _strip(self, times: Floats) -> Indices:
        with np.errstate(divide="ignore"):
            u = STRETCH * np.arcsinh((np.log(times) - np.log1p(-times)) / STRETCH)
        place = np.clip((u + FARTHEST) / SPACING, -1.0, round(2 * FARTHEST / SPACING) + 1.0)
        return np.asarray((place + 1.5) * STRIPS, dtype=np.intp)


def time_of(u: Floats) -> Floats:
    """Return the times in (0, 1) of stretched ones."""
    times: Floats = 1.0 / (1.0 + np.exp(-STRETCH * np.sinh(u / STRETCH)))
    return times


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


def _weights(offset: float) -> tuple[list[float], list[float]]:
    """Return by how much each sample of a window counts at an offset from its middle.

    Returns
    -------
    fit, mean : list of float, length 2 HALF_WINDOW + 1
        Of the value of the fitted parabola, and of the mean; both sum to 1.
    """
    # In a frame that is played, this is most of the cost; so short arrays are slower than lists.
    place = [(i - offset) / (HALF_WINDOW + 0.5) for i in range(-HALF_WINDOW, HALF_WINDOW + 1)]
    bump = [math.exp(-1.0 / max(1.0 - x * x, 1e-3)) for x in place]
    # The first row of the inverse of the parabola's normal equations, by its cofactors.
    first = list(map(mul, bump, place))
    second = list(map(mul, first, place))
    m0, m1, m2 = sum(bump), sum(first), sum(second)
    m3, m4 = _dot(second, place), _dot(second, list(map(mul, place, place)))
    c0, c1, c2 = m2 * m4 - m3 * m3, m2 * m3 - m1 * m4, m1 * m3 - m2 * m2
    whole = m0 * c0 + m1 * c1 + m2 * c2
    fit = [(c0 * b + c1 * x + c2 * y) / whole for b, x, y in zip(bump, first, second, strict=True)]
    return fit, [b / m0 for b in bump]


@cache
def _steepness() -> tuple[float, float]:
    """Return how fast a fit and a mean may change with the offset, over the range of the values."""
    offsets = np.linspace(-0.5, 0.5, 1025)
    fits, means = (np.array(each) for each in zip(*map(_weights, offsets), strict=True))
    # The weights are smooth; the margin covers what their steepest place is off the samples.
    return tuple(
        1.05 * float(np.abs(np.diff(each, axis=0)).sum(axis=1).max()) * 1024 / 2
        for each in (fits, means)
    )  # type: ignore[return-value]


def _dot(one: list[float], two: list[float]) -> float:
    total: float = sum(map(mul, one, two))
    return total


def _fits(values: Floats, offset: float) -> Floats:
    """Return the fit at an offset from each sample, like `values`; they are 0 beyond the ends."""
    windows = sliding_window_view(np.pad(values, HALF_WINDOW), 2 * HALF_WINDOW + 1)
    fits: Floats = windows @ np.array(_weights(offset)[0])
    return fits
