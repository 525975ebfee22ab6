"""A scaling ρ that is C^∞ in time (Section 5.5 leaves that to others)."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.optimize import minimize_scalar

from engine.arrays import Floats, readonly
from engine.interpolation.scaling import Scaling

# Time is stretched to x = log(t / (1 − t)), so that a window of constant width in x narrows towards
# both keyframes, where ρ has to stay 1.
SPACING = 1 / 16
RESOLVED = 15.0  # |x| up to which ρ is sampled at every SPACING, and beyond it at every 1
FARTHEST = 34.0  # |x| from which on time is a keyframe's, to rounding
HALF_WINDOW = 4  # samples on each side over which the mean is taken


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SmoothScaling:
    """A C^∞ function of time between two keyframes, nowhere above the sharp ρ, and 1 at both.

    The minimum of the sharp ρ over a window is averaged over a slightly smaller one with C^∞
    weights. What scales η less than a sharp ρ would break the bounds; what scales it more does not.

    Parameters
    ----------
    minima : float64, shape (2 FARTHEST / SPACING + 1,)
        Of the sharp ρ over a window around each sample of x.
    """

    minima: Floats

    @classmethod
    def of(cls, sharp: Scaling) -> Self:
        """Sample a sharp ρ, some 500 times, and take its minima."""

        def rho(x: float) -> float:
            return sharp(_weights(x))

        fine = np.linspace(-RESOLVED, RESOLVED, round(2 * RESOLVED / SPACING) + 1)
        inner = np.array([rho(x) for x in fine])
        # Next to each lowest sample the curve may go lower still.
        for k in np.flatnonzero((inner[1:-1] <= inner[:-2]) & (inner[1:-1] <= inner[2:])) + 1:
            if inner[k] < 1.0:
                bounds = (fine[k - 1], fine[k + 1])
                inner[k] = min(inner[k], minimize_scalar(rho, bounds=bounds, method="bounded").fun)
        coarse = np.arange(RESOLVED, FARTHEST + 1)
        before, after = (
            np.repeat(np.minimum(values[1:], values[:-1]), round(1 / SPACING))
            for values in ([np.array([rho(sign * x) for x in coarse]) for sign in (-1.0, 1.0)])
        )
        samples = np.concatenate([before[::-1], inner, after])
        reach = HALF_WINDOW + 1
        padded = np.pad(samples, reach, constant_values=1.0)
        return cls(minima=readonly(sliding_window_view(padded, 2 * reach + 1).min(axis=1)))

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return self.minima.nbytes

    def __call__(self, weights: Floats) -> float:
        """Return the smooth ρ for the weights (2,) of the two keyframes."""
        if weights[0] <= 0.0 or weights[1] <= 0.0:
            return 1.0
        place = (np.log(weights[1] / weights[0]) + FARTHEST) / SPACING
        window = np.arange(
            int(np.floor(place)) - HALF_WINDOW, int(np.floor(place)) + HALF_WINDOW + 2
        )
        distance = (window - place) / HALF_WINDOW
        inside = np.abs(distance) < 1.0
        bump = np.exp(-1.0 / (1.0 - distance[inside] ** 2))
        values = np.array([self._minimum(k) for k in window[inside]])
        return float(bump @ values / bump.sum())

    def _minimum(self, k: int) -> float:
        return float(self.minima[k]) if 0 <= k < len(self.minima) else 1.0


def _weights(x: float) -> Floats:
    """Return 1 − t and t, each to all its digits."""
    return np.array([1.0 / (1.0 + np.exp(x)), 1.0 / (1.0 + np.exp(-x))])
