"""Weights in time: which keyframes an in-between blends, and how much of each.

Every proof of the bounds needs convex weights. Inside an interval an easing keeps them so and moves
the same in-betweens only faster or slower; splines across the keys do not.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from engine.arrays import Floats
from engine.errors import EngineError

Easing = Callable[[float], float]


def linear(fraction: float) -> float:
    """Move at constant speed."""
    return fraction


def smooth(fraction: float) -> float:
    """Start and stop gently: C¹ in time across keys."""
    return fraction * fraction * (3.0 - 2.0 * fraction)


@dataclass(frozen=True, slots=True, kw_only=True)
class Moment:
    """The keyframes from `first` on, and their weights (k,) of sum 1."""

    first: int
    weights: Floats


def eased_moment(time: float, count: int, easing: Easing) -> Moment:
    """Blend the two keyframes around a time; keyframe i is at time i.

    Raises
    ------
    EngineError
        If the time is not in [0, count − 1], or the easing leaves [0, 1] or does not lead from 0
        to 1.
    """
    first = min(int(_checked(time, count)), count - 2)
    fraction = time - first
    eased = float(easing(fraction))
    if not 0.0 <= eased <= 1.0 or (fraction in (0.0, 1.0) and eased != fraction):
        raise EngineError(
            f"The easing takes {fraction:g} to {eased:g}; it must lead from 0 to 1 and stay "
            "between them, or the bounds on distortion are lost."
        )
    return Moment(first=first, weights=np.array([1.0 - eased, eased]))


def spline_moment(time: float, count: int) -> Moment:
    """Blend all keyframes with the weights of the natural cubic spline through them.

    C² in time, but some weights are negative: the bounds can be left between the keyframes.
    """
    _checked(time, count)
    weights = CubicSpline(np.arange(count), np.eye(count), bc_type="natural")(time)
    if time == int(time):
        # Exactly the keyframe, so that nothing of the others is blended in by rounding.
        weights = np.eye(count)[int(time)]
    return Moment(first=0, weights=weights)


def _checked(time: float, count: int) -> float:
    if not 0.0 <= time <= count - 1:
        raise EngineError(
            f"Time {time:g} is out of range: {count} keyframes span the times from 0 to "
            f"{count - 1}."
        )
    return time
