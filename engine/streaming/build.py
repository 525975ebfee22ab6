"""From directly computed in-betweens to series, with few time functions and few samples."""

from collections.abc import Generator
from math import inf

import numpy as np

from engine.arrays import Floats
from engine.streaming.components import MotionComponents
from engine.streaming.functions import TimeFunctions
from engine.streaming.series import Series
from engine.streaming.splitting import OF_PIECES, PiecewiseReducedModel, split_motion

# Shares of the tolerance; the rest is for rounding to float32. Points that were not probed may
# exceed the error; then the search is repeated with a smaller tolerance.
OF_FUNCTIONS = 0.2
CHECKED = 0.7  # of the tolerance, at the checked times; between them the error may be larger
MARGIN = 1.4  # factor on the error between the checked times
BESIDE = (0.25, 0.75)  # further checked times, as shares of the first and the last gap
GAPS = 3  # the series is checked in the middle of so many widest gaps between samples
TIGHTER, ROUNDS = 1 / 4, 3


def build_series(channels: MotionComponents) -> Generator[None, None, Series]:
    """Build the series of a segment, a small part at each step.

    A step costs at most about one direct evaluation. The caller may leave the generator at any
    step.

    Departs from the paper: Section 7 computes every in-between anew.

    Notes
    -----
    All points of a motion share the same few functions of time, found from some of the points. The
    direct evaluation is sampled at as many times as there are functions, chosen to separate the
    functions best. These samples determine the motion of all points (discrete empirical
    interpolation: Chaturantabut and Sorensen 2010, with the pivots of Drmač and Gugercin 2016). The
    motion is split into pieces of time for which a linear blend and two functions suffice. The
    result is compared with the direct evaluation. Times without an accurate piece are left out.
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
            # At unchecked times the error is the share of the functions and pieces.
            least = (OF_FUNCTIONS + OF_PIECES) * channels.tolerance
            return Series(pieces=pieces, error=max(MARGIN * error, least))
    return Series(pieces=(), error=inf)


def _between(times: Floats) -> list[float]:
    """Return the times to check: beside both ends, and in the middle of the widest gaps.

    Beside a keyframe a motion may bend within a part of the first gap.
    """
    every = np.concatenate([[0.0], times, [1.0]])
    widths = np.diff(every)
    middles = every[:-1] + widths / 2
    beside = [share * widths[0] for share in BESIDE]
    beside += [1.0 - share * widths[-1] for share in BESIDE]
    return sorted({*beside, *middles[widths.argsort()[-GAPS:]].tolist()})
