"""The corrections of a segment, solved at few times and written as series."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats, freeze
from engine.deform.correction.barrier import extremes
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame
from engine.deform.correction.limits import frame_limits, max_feasible_share, solve_within
from engine.deform.correction.solver import PointSolution
from engine.interpolation.added.pins.targets import SegmentPins
from engine.interpolation.series.chebyshev import (
    PiecewiseSeries,
    chebyshev_nodes,
    constant_one,
    separate_variables,
)
from engine.maps import Bounds

# Accuracy of the series and of the omitted terms. Unknowns are of the size of |h|, and positions
# relative to the size of the domain: some hundredths of a pixel in a thousand.
TOLERANCE, LEFT_OUT = 2e-5, 4e-6
SHORTEST = 2.0**-2  # pieces of time are not halved below this
DEGREES = (8, 16)
# Distance of solved corrections from the limits, for what the series add between the solved times;
# how far keyframes at a limit are exceeded; and the distance at which the barrier begins.
INNER, BEYOND_KEYS, WALL = 0.01, 0.001, 0.001
# Times at which a segment that reaches its limits is checked, and again if it breaks them.
CHECKED, CHECKED_AGAIN = 64, 256


class _AtLimitsError(Exception):
    """Raised when the first correction of a segment comes near the limits, or ends early."""


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
    extremes of the keyframes. Each solved correction keeps them by itself, so that pinned points
    stay where limits act elsewhere.
    """
    known, size = corrector.variables, corrector.boundary.size
    solved: dict[float, PointSolution] = {}
    limits = _SegmentLimits.of(corrector, base_at, bounds)
    is_smooth = True

    def at(time: float) -> Floats:
        if time not in solved:
            near = min(solved, key=lambda other: abs(other - time), default=None)
            start = None if near is None else solved[near]
            solved[time] = _solve_at(corrector, base_at(time), pins, limits, time, start)
        found = solved[time]
        if is_smooth and (found.is_limited or not found.is_finished):
            raise _AtLimitsError
        return np.append(found.x, [found.shift.real / size, found.shift.imag / size])

    def values(times: Floats) -> Floats:
        return np.array([at(time) for time in times.tolist()]).T

    def largest_share(forms: Floats, series: PiecewiseSeries, count: int) -> float:
        """Return the share of a series that keeps the limits between the solved times."""
        share, few = 1.0, known.at_samples.in_forms(forms[:-2])
        for time in ((1.0 + chebyshev_nodes(count)) / 2).tolist():
            x = share * np.tile(series(time), 2)
            share *= max_feasible_share(few, base_at(time).samples, x, limits.kept)
        return share

    resolve = partial(separate_variables, values, left_out=LEFT_OUT)
    try:
        forms, series = resolve(tolerance=TOLERANCE, shortest=SHORTEST, degrees=DEGREES)
        share = 1.0
    except _AtLimitsError:
        is_smooth = False
        # Where limits act, corrections are not analytic in time: one series has to do. Pinned
        # points are then within some hundredths of a pixel in a thousand.
        for degree in DEGREES:
            forms, series = resolve(tolerance=np.inf, degrees=(degree,))
            share = largest_share(forms, series, CHECKED)
            if share == 1.0:
                break
        else:
            share = min(share, largest_share(forms, series, CHECKED_AGAIN))
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
    limits = _SegmentLimits.of(corrector, base_at, bounds)
    found = _solve_at(corrector, base_at(time), pins, limits, time)
    return CorrectionSeries.of_frame(corrector, found.x, found.shift)


class _SegmentLimits(NamedTuple):
    """Limits of ln σ_a, −ln σ_b and k in a segment, (3,).

    `kept` are the bounds, widened by the extremes of the keyframes, and `inner` those of each
    solved correction.
    """

    kept: Floats
    inner: Floats

    @classmethod
    def of(
        cls,
        corrector: PointCorrector,
        base_at: Callable[[float], CorrectionBase],
        bounds: Bounds,
    ) -> Self:
        ends = [extremes(corrector, base_at(time).samples) for time in (0.0, 1.0)]
        inner = frame_limits(bounds, *(end + BEYOND_KEYS for end in ends), inside=INNER)
        return cls(frame_limits(bounds, *(end + 2 * BEYOND_KEYS for end in ends)), inner)


def _solve_at(
    corrector: PointCorrector,
    base: CorrectionBase,
    pins: SegmentPins,
    limits: _SegmentLimits,
    time: float,
    start: PointSolution | None = None,
) -> PointSolution:
    """Find the correction at a time, from one at another time."""
    targets = pins.targets(time, base.places, base.anchor)
    own = extremes(corrector, base.samples) + WALL
    inner = np.maximum(limits.inner, own)
    return solve_within(
        corrector, base.nodes, base.samples, targets, inner, width=WALL, start=start
    )
