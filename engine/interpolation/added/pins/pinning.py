"""The corrections of a segment, solved at few times and written as series."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats, freeze
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.solver import PointSolution
from engine.interpolation.added.pins.segment_solver import (
    DEGREE,
    CorrectionBase,
    SegmentSolver,
)
from engine.interpolation.added.pins.targets import SegmentPins
from engine.interpolation.series.chebyshev import (
    PiecewiseSeries,
    constant_one,
    separate_variables,
)
from engine.maps import Bounds

# Accuracy of the series and of the omitted terms. Unknowns are of the size of |h|, and positions
# relative to the size of the domain: some hundredths of a pixel in a thousand.
TOLERANCE, LEFT_OUT = 2e-5, 4e-6
SHORTEST = 2.0**-2  # pieces of time are not halved below this
DEGREES = (8, DEGREE)


class _AtLimitsError(Exception):
    """Raised when a correction of a segment comes near the limits, or ends early."""


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
    extremes of the keyframes. Each solved correction keeps them by itself, so that pinned points
    stay where limits act elsewhere.
    """
    known, size = corrector.variables, corrector.boundary.size
    segment = SegmentSolver(corrector, base_at, pins, bounds)

    def unknowns(found: PointSolution) -> Floats:
        return np.append(found.x, [found.shift.real / size, found.shift.imag / size])

    def smooth(times: Floats) -> Floats:
        found = [segment.solve(time) for time in times.tolist()]
        if not all(segment.is_away(time) for time in times.tolist()):
            raise _AtLimitsError
        return np.array([unknowns(each) for each in found]).T

    resolve = partial(separate_variables, left_out=LEFT_OUT)
    try:
        forms, series = resolve(smooth, tolerance=TOLERANCE, shortest=SHORTEST, degrees=DEGREES)
        share = 1.0
    except _AtLimitsError:
        # Where limits act, corrections are not analytic in time: one series has to do. Pinned
        # points are then within some hundredths of a pixel in a thousand.
        known_at, is_kept = segment.solve_series_within_limits()
        forms, series = resolve(
            lambda times: np.array([unknowns(known_at[time]) for time in times.tolist()]).T,
            tolerance=np.inf,
            degrees=(DEGREE,),
        )
        share = segment.feasible_share(forms[:-2], series, is_kept=is_kept)
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
    """Find the correction at a single time, which costs a fraction of the whole segment's."""
    found = SegmentSolver(corrector, base_at, pins, bounds).solve_within_limits(time)
    return CorrectionSeries.of_frame(corrector, found.x, found.shift)
