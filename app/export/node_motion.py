"""The motion of a whole layer for other programs: place, rotation and scale over time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import pi
from typing import Final

import numpy as np

from engine.arrays import Complexes, Floats, freeze
from engine.geometry import IDENTITY_MOTION, Similarity

SHORTEST: Final = 2.0**-6  # frames of a jump, in which no tolerance is kept
LONGEST_TURN: Final = pi / 2  # between two times; readers take the short way
# Columns of a motion.
X, Y, TURN, SCALE = range(4)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class NodeMotion:
    """A similarity over time, linear in place, rotation and scale between times.

    Parameters
    ----------
    pivot : complex
        The point of the layer that is at the place.
    times : float64, shape (n,)
    values : float64, shape (n, 4)
        x and y of the place, rotation in radians without jumps by whole turns, and scale.
    """

    pivot: complex
    times: Floats
    values: Floats

    def at(self, time: float) -> Similarity:
        x, y, turn, scale = (np.interp(time, self.times, column) for column in self.values.T)
        factor = scale * np.exp(1j * turn)
        return Similarity(complex(factor), complex(x + 1j * y - factor * self.pivot))


def build_node_motion(
    placement: Callable[[float], Similarity],
    points: Complexes,
    pivot: complex,
    times: Sequence[float],
    tolerance: float,
) -> NodeMotion | None:
    """Return the motion of a layer's points within a tolerance in pixels; None if it rests.

    `times` are increasing, and so close that every change shows halfway between two.
    """
    radius = float(np.abs(points - pivot).max(initial=1.0))
    # Changes in pixels of the farthest point.
    weights = np.array([1.0, 1.0, radius, radius])
    known: dict[float, Floats] = {}
    rests = True

    def value(time: float) -> Floats:
        nonlocal rests
        if time not in known:
            moved = placement(time)
            rests = rests and moved == IDENTITY_MOTION
            at = moved.factor * pivot + moved.shift
            known[time] = np.array([at.real, at.imag, np.angle(moved.factor), abs(moved.factor)])
        return known[time]

    def refine(first: float, last: float) -> list[float]:
        """Return times after the first up to the last, so close that motion is linear."""
        middle = (first + last) / 2
        halfway = _unwrapped(np.array([value(first), value(middle), value(last)]))
        bend = np.abs(halfway[1] - (halfway[0] + halfway[2]) / 2) @ weights
        if bend <= tolerance / 2 or last - first <= SHORTEST:
            return [last]
        return [*refine(first, middle), *refine(middle, last)]

    value(times[0])
    moments = [times[0], *(time for pair in pairwise(times) for time in refine(*pair))]
    if rests:
        return None
    values = _unwrapped(np.array([value(time) for time in moments]))
    kept = _thinned(np.array(moments), values, weights, tolerance / 2)
    return NodeMotion(
        pivot=pivot, times=freeze(np.array(moments)[kept]), values=freeze(values[kept])
    )


def _unwrapped(values: Floats) -> Floats:
    unwrapped = values.copy()
    unwrapped[:, TURN] = np.unwrap(values[:, TURN])
    return unwrapped


def _thinned(times: Floats, values: Floats, weights: Floats, tolerance: float) -> list[int]:
    """Return the indices of times between which all others lie on lines, within a tolerance."""
    kept, waiting = [0], [(0, len(times) - 1)]
    while waiting:
        first, last = waiting.pop()
        shares = (times[first : last + 1] - times[first]) / max(times[last] - times[first], 1e-12)
        lines = values[first] + shares[:, None] * (values[last] - values[first])
        errors = np.abs(values[first : last + 1] - lines) @ weights
        turned = abs(values[last, TURN] - values[first, TURN])
        if last - first > 1 and (errors.max() > tolerance or turned > LONGEST_TURN):
            middle = first + (int(errors.argmax()) or (last - first) // 2)
            middle = min(max(middle, first + 1), last - 1)
            waiting += [(first, middle), (middle, last)]
        elif last > first:
            kept.append(last)
    return sorted(kept)
