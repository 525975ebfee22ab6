"""The corrections of a segment, solved at few times and written as series."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats, freeze
from engine.deform.correction.barrier import extremes
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame
from engine.deform.correction.limits import frame_limits, max_feasible_share
from engine.deform.correction.solver import PointSolution, solve_correction
from engine.interpolation.added.pins.targets import SegmentPins
from engine.interpolation.series.chebyshev import (
    PiecewiseSeries,
    chebyshev_nodes,
    constant_one,
    separate_variables,
)
from engine.maps import Bounds

# Accuracy of the series and of the omitted terms. Unknowns are of the size of |h|, and positions
# relative to the size of the domain: some thousandths of a pixel in a thousand.
TOLERANCE, LEFT_OUT = 5e-6, 1e-6
SHORTEST = 2.0**-3  # pieces of time are not halved below this
DEGREES = (8, 16)
# If so many solves end early, the targets are far out of reach. One series of this degree will do:
# a finer one would only follow where each solve has ended.
OUT_OF_REACH, ROUGHLY = 3, 16
CHECKED = 64  # times at which a segment that reaches its limits is checked again


class _OutOfReachError(Exception):
    """Raised when too many solves of a segment have ended early."""


class CorrectionBase(NamedTuple):
    """An in-between before its correction, at one time.

    `places` and `fz` are at the handles, complex128 (m,). `nodes` and `samples` are the base at the
    nodes of the corrector's paths, and at the samples of the boundary.
    """

    places: Complexes
    fz: Complexes
    anchor: complex
    nodes: BaseFrame
    samples: BaseFrame


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CorrectionSeries:
    """h, q and a translation: few functions times series in time.

    Attributes
    ----------
    h, q : complex128, shape (n, j)
        The functions in the domain's span.
    shifts : complex128, shape (j,)
        Coefficients of the translation.
    share : float
        Applied share of the correction, reduced to keep the limits; 1 is the whole correction.
    """

    series: PiecewiseSeries
    h: Complexes
    q: Complexes
    shifts: Complexes
    share: float = 1.0

    @classmethod
    def of_frame(cls, corrector: PointCorrector, x: Floats, shift: complex) -> Self:
        """Return a correction of one frame, the same at all times."""
        known = corrector.variables
        h, q = np.split(x, 2)
        return cls(
            series=constant_one(),
            h=freeze((known.h @ h)[:, None]),
            q=freeze((known.q @ q)[:, None]),
            shifts=freeze(np.array([shift])),
        )

    def shift(self, times: Floats) -> Complexes:
        """Return the translation at times (t,)."""
        moved: Complexes = self.series.at(times).T @ self.shifts
        return moved


def fit_pin_corrections(
    corrector: PointCorrector,
    base_at: Callable[[float], CorrectionBase],
    pins: SegmentPins,
    bounds: Bounds,
) -> CorrectionSeries:
    """Find the corrections of a segment.

    `base_at` returns the base at a time in [0, 1]. The samples keep `bounds`, widened by the
    extremes of the keyframes.
    """
    known, size = corrector.variables, corrector.boundary.size
    solved: dict[float, PointSolution] = {}
    share, most_unfinished = 1.0, float(OUT_OF_REACH)
    limits = _limits(corrector, base_at, bounds)

    def at(time: float) -> Floats:
        nonlocal share
        if time in solved:
            return unknowns(solved[time])
        base = base_at(time)
        targets = pins.targets(time, base.places, base.anchor)
        near = min(solved, key=lambda other: abs(other - time), default=None)
        start = None if near is None else solved[near]
        solved[time] = found = solve_correction(corrector, base.nodes, targets, start, throw=False)
        share = min(share, max_feasible_share(corrector, base.samples, found.x, limits))
        if sum(not each.is_finished for each in solved.values()) >= most_unfinished:
            raise _OutOfReachError
        return unknowns(found)

    def unknowns(found: PointSolution) -> Floats:
        return np.append(found.x, [found.shift.real / size, found.shift.imag / size])

    def values(times: Floats) -> Floats:
        return np.array([at(time) for time in times.tolist()]).T

    try:
        forms, series = separate_variables(
            values, tolerance=TOLERANCE, left_out=LEFT_OUT, shortest=SHORTEST, degrees=DEGREES
        )
    except _OutOfReachError:
        most_unfinished = np.inf
        forms, series = separate_variables(
            values, tolerance=np.inf, left_out=LEFT_OUT, degrees=(ROUGHLY,)
        )
    if share < 1.0:
        # Near the limits the series may exceed them between the solved times.
        for time in ((1.0 + chebyshev_nodes(CHECKED)) / 2).tolist():
            x, samples = (forms @ series(time))[:-2], base_at(time).samples
            share = min(share, max_feasible_share(corrector, samples, x, limits))
    # One share for the whole segment, so that a limit reached for a moment causes no jolt.
    forms *= share
    count = known.count
    return CorrectionSeries(
        series=series,
        h=freeze(known.h @ forms[:count]),
        q=freeze(known.q @ forms[count:-2]),
        shifts=freeze(size * (forms[-2] + 1j * forms[-1])),
        share=share,
    )


def solve_pin_correction(
    corrector: PointCorrector,
    base_at: Callable[[float], CorrectionBase],
    pins: SegmentPins,
    bounds: Bounds,
    time: float,
) -> CorrectionSeries:
    """Find the correction at a single time, which costs a fraction of the whole segment's.

    The share is that of this time alone. It differs from the segment's where the segment reaches
    its limits.
    """
    limits, base = _limits(corrector, base_at, bounds), base_at(time)
    targets = pins.targets(time, base.places, base.anchor)
    found = solve_correction(corrector, base.nodes, targets, throw=False)
    share = max_feasible_share(corrector, base.samples, found.x, limits)
    return CorrectionSeries.of_frame(corrector, share * found.x, share * found.shift)


def _limits(
    corrector: PointCorrector, base_at: Callable[[float], CorrectionBase], bounds: Bounds
) -> Floats:
    """Return the limits of a segment: the bounds, widened by the extremes of the keyframes."""
    ends = [extremes(corrector, base_at(time).samples) for time in (0.0, 1.0)]
    return frame_limits(bounds, *ends)
