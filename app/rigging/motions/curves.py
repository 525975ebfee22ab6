"""Periodic functions of the phase of a cycle."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import maximum_filter1d, uniform_filter1d

EIGHTHS = tuple(number / 8 for number in range(8))  # phases of key poses
SAMPLES = 64  # of a cycle
Periodic = Callable[[float], float]  # of the phase, with period 1


@dataclass(frozen=True, slots=True)
class Curve:
    """A periodic C² curve through a few values, each at its phase in [0, 1)."""

    values: tuple[tuple[float, float], ...]  # ascending phases, and the value at each

    def __call__(self, phase: float) -> float:
        first = self.values[0][0]
        return float(_spline(self)(first + (phase - first) % 1.0))


@lru_cache(maxsize=1024)
def _spline(curve: Curve) -> CubicSpline:
    phases, heights = zip(*curve.values, strict=True)
    if len(phases) == 1:
        phases, heights = (phases[0], phases[0] + 0.5), 2 * heights
    return CubicSpline([*phases, phases[0] + 1.0], [*heights, heights[0]], bc_type="periodic")


def even_curve(*values: float) -> Curve:
    """Return a curve through values at evenly spaced phases, the first one at 0."""
    return Curve(tuple((number / len(values), value) for number, value in enumerate(values)))


STEADY = even_curve(0.0)


def count_swings(curve: Periodic) -> int:
    """Return how often a curve swings in a cycle: the number of its largest harmonic."""
    samples = [curve(number / SAMPLES) for number in range(SAMPLES)]
    return 1 + int(np.abs(np.fft.rfft(samples))[1:].argmax())


def bump(share: float) -> float:
    """Return a C² bump over [0, 1], 1 in the middle and 0 outside."""
    inside = min(max(share, 0.0), 1.0)
    return 64 * inside**3 * (1 - inside) ** 3


def covering_curve(heights: Sequence[float], width: int) -> Curve:
    """Return a smooth curve that is never below these heights at evenly spaced phases.

    `width` is the odd number of heights over which it is smoothed.
    """
    most = maximum_filter1d(np.asarray(heights), 2 * width + 1, mode="wrap")
    # A mean of the maxima around a phase is at least as high as the value there.
    smooth = uniform_filter1d(uniform_filter1d(most, width, mode="wrap"), width, mode="wrap")
    return even_curve(*smooth.tolist())


def hermite(share: float, start: float, end: float, slope: float) -> float:
    """Return a quintic from one value to another, with one slope and no curvature at both ends."""
    rest = end - start - slope
    return start + slope * share + rest * share**3 * (10 - 15 * share + 6 * share**2)


@dataclass(frozen=True, slots=True)
class Leap:
    """A C¹ leap from one phase to another, 0 before and after."""

    first: float
    last: float
    height: float

    def __call__(self, phase: float) -> float:
        share = (phase % 1.0 - self.first) / (self.last - self.first)
        return self.height * 16 * (share * (1 - share)) ** 2 if 0 < share < 1 else 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmDirection:
    """The direction of a bone of an arm on the page, however the arm is drawn.

    Angles are in degrees: 0 points down, 90 points outwards, or ahead from the side, 180 points up.
    """

    angle: float
    share: Periodic  # of the way from the drawn direction, 0 to 1
    swing: Periodic = STEADY  # added to the direction, in degrees
