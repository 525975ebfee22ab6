"""From the direct path to series: few functions of time, found cheaply, and few samples."""

from collections.abc import Generator
from math import inf

import numpy as np

from engine.arrays import Floats
from engine.streaming.components import MotionComponents
from engine.streaming.functions import TimeFunctions
from engine.streaming.series import Series
from engine.streaming.splitting import OF_PIECES, PiecewiseReducedModel, split_motion

# Shares of the tolerance; the rest is for rounding to float32. What is found at some points may be
# exceeded at others: then it is tried again with less.
OF_FUNCTIONS = 0.2
CHECKED = 0.7  # of the tolerance, at the times that are looked at; between them it may be more
MARGIN = 1.4  # by which it may be more there
BESIDE = (0.25, 0.75)  # of the first and the last gap, where it is looked at, too
GAPS = 3  # between the samples, the widest, in the middle of which the series is looked at
TIGHTER, ROUNDS = 1 / 4, 3


def build_series(channels: MotionComponents) -> Generator[None, None, Series]:
    """Build the series of an interval, a small part at each step.

    A step is about one evaluation of the direct path or less. The generator may be left at any
    step.

    Departs from the paper: Section 7 works out every in-between anew.

    Notes
    -----
    All points of a motion are written in the same few functions of time, which are found at some
    of them. As many samples of the direct path as there are functions, at the times that tell them
    apart best, then give the motion of all points (discrete empirical interpolation: Chaturantabut
    and Sorensen 2010, with the pivots of Drmač and Gugercin 2016). It is cut into pieces of time
    so short that two functions beside a linear blend suffice, and compared with the direct path.
    Stretches that no piece is accurate on are left out.
    """
    values: dict[float, Floats] = {}
    for time in (0.0, 1.0):
        values[time] = channels.sample(time)
        yield
    for attempt in range(ROUNDS):
        tolerance = TIGHTER**attempt * channels.tolerance
        functions = yield from TimeFunctions.of(channels.probe, OF_FUNCTIONS * tolerance)
        for time in functions.times.tolist():
            if time not in values:
                values[time] = channels.sample(time)
                yield
        inner = np.array(sorted(set(values) - {0.0, 1.0}))
        known = np.array([values[time] for time in (0.0, 1.0, *inner.tolist())])
        motion = PiecewiseReducedModel.through(functions, inner, known)
        pieces = yield from split_motion(motion, tolerance)
        found = Series(pieces=pieces, error=0.0)
        error = 0.0
        for time in _between(inner):
            if found.covers(time):
                values[time] = channels.sample(time)
                error = max(error, float(np.abs(found.values(time) - values[time]).max()))
                yield
        if pieces and error <= CHECKED * channels.tolerance:
            # Where nothing was looked at the error is what functions and pieces were allowed.
            least = (OF_FUNCTIONS + OF_PIECES) * channels.tolerance
            return Series(pieces=pieces, error=max(MARGIN * error, least))
    return Series(pieces=(), error=inf)


def _between(times: Floats) -> list[float]:
    """Return where values at times are missed most: beside both ends, and in the widest gaps.

    Beside a keyframe a motion may bend within a part of the first gap.
    """
    every = np.concatenate([[0.0], times, [1.0]])
    widths = np.diff(every)
    middles = every[:-1] + widths / 2
    beside = [share * widths[0] for share in BESIDE]
    beside += [1.0 - share * widths[-1] for share in BESIDE]
    return sorted({*beside, *middles[widths.argsort()[-GAPS:]].tolist()})
