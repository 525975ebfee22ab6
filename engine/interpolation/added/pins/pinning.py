"""The corrections of a segment, solved at few times and written as series."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats, freeze
from engine.deform.correction.barrier import extremes
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame
from engine.deform.correction.limits import (
    INSIDE,
    frame_limits,
    max_feasible_share,
    solve_within,
)
from engine.deform.correction.point_targets import PointTargets
from engine.deform.correction.solver import PointSolution, solve_correction
from engine.interpolation.added.pins.targets import SegmentPins
from engine.interpolation.added.pins.time_limits import (
    CheckedTime,
    SolvedNode,
    keep_limits_in_time,
)
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
# Number of pieces of a segment at whose ends its limits are kept, and of those at whose ends they
# are checked, the more closely if they could not be kept; and the slack at the first ones, for what
# happens between them.
CHECKED, CHECKED_AGAIN, CHECKED_CLOSELY, SLACK = 64, 128, 256, 2e-4


class _AtLimitsError(Exception):
    """Raised when a correction of a segment comes near the limits, or ends early."""


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
    segment = _Segment(corrector, base_at, pins, _SegmentLimits.of(corrector, base_at, bounds))

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
        each, is_kept = segment.solve_within_limits()
        found = dict(zip(segment.times, each, strict=True))
        forms, series = resolve(
            lambda times: np.array([unknowns(found[time]) for time in times.tolist()]).T,
            tolerance=np.inf,
            degrees=DEGREES[-1:],
        )
        count = CHECKED_AGAIN if is_kept else CHECKED_CLOSELY
        share = segment.feasible_share(forms[:-2], series, count)
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


class _Segment:
    """The corrections of a segment at its times, each solved once."""

    def __init__(
        self,
        corrector: PointCorrector,
        base_at: Callable[[float], CorrectionBase],
        pins: SegmentPins,
        limits: _SegmentLimits,
    ) -> None:
        self.corrector, self.limits = corrector, limits
        self._base_at, self._pins = lru_cache(CHECKED + 1)(base_at), pins
        self._solved: dict[float, PointSolution] = {}

    @property
    def times(self) -> list[float]:
        """The nodes of a series of the highest degree."""
        return _chebyshev_times(DEGREES[-1])

    def solve(self, time: float) -> PointSolution:
        """Find the smallest correction at a time, from the nearest solved one, without limits."""
        if time not in self._solved:
            near = min(self._solved, key=lambda other: abs(other - time), default=None)
            start = None if near is None else self._solved[near]
            nodes, targets = self._base_at(time).nodes, self._targets(time)
            self._solved[time] = solve_correction(
                self.corrector, nodes, targets, start, throw=False
            )
        return self._solved[time]

    def is_away(self, time: float) -> bool:
        """Return whether a solved correction converged and is away from the limits."""
        reached = extremes(self.corrector, self._base_at(time).samples, self._solved[time].x)
        away = bool((reached <= self._inner(time) - WALL).all())
        return away and self._solved[time].is_finished

    def solve_within_limits(self) -> tuple[list[PointSolution], bool]:
        """Find corrections at all nodes whose series keeps the limits between them, too.

        The second value tells whether it does.

        Pinned points stay where limits act elsewhere. If points are out of reach, corrections that
        keep the limits are solved first, each by itself.
        """
        checked = [
            CheckedTime(time, self._base_at(time).samples, self._kept(time) - SLACK)
            for time in _chebyshev_times(CHECKED)
        ]
        found: list[PointSolution] = []
        for solve in (self.solve, self._solve_walled):
            nodes = [
                SolvedNode(self._base_at(time).nodes, self._targets(time), solve(time))
                for time in self.times
            ]
            if not (solve == self._solve_walled or all(n.solution.is_finished for n in nodes)):
                continue
            found, is_kept = keep_limits_in_time(self.corrector, nodes, checked)
            if is_kept:
                return found, True
        return [node.solution for node in nodes], False

    def feasible_share(self, forms: Floats, series: PiecewiseSeries, pieces: int) -> float:
        """Return the share of a series that keeps the limits, also between the checked times."""
        share, few = 1.0, self.corrector.variables.at_samples.in_forms(forms)
        for time in _chebyshev_times(pieces):
            x, samples = share * np.tile(series(time), 2), self._base_at(time).samples
            share *= max_feasible_share(few, samples, x, self.limits.kept)
        return share

    def _solve_walled(self, time: float) -> PointSolution:
        base = self._base_at(time)
        return _solve_at(self.corrector, base, self._pins, self.limits, time)

    def _targets(self, time: float) -> PointTargets:
        base = self._base_at(time)
        return self._pins.targets(time, base.places, base.anchor)

    def _inner(self, time: float) -> Floats:
        own = extremes(self.corrector, self._base_at(time).samples) + WALL
        return np.maximum(self.limits.inner, own)

    def _kept(self, time: float) -> Floats:
        own = extremes(self.corrector, self._base_at(time).samples) + INSIDE
        return np.maximum(self.limits.kept, own)


def _chebyshev_times(degree: int) -> list[float]:
    times: list[float] = ((1.0 + chebyshev_nodes(degree)) / 2).tolist()
    return times


def _solve_at(
    corrector: PointCorrector,
    base: CorrectionBase,
    pins: SegmentPins,
    limits: _SegmentLimits,
    time: float,
) -> PointSolution:
    """Find the correction at a time within the limits at that time."""
    targets = pins.targets(time, base.places, base.anchor)
    own = extremes(corrector, base.samples) + WALL
    inner = np.maximum(limits.inner, own)
    return solve_within(corrector, base.nodes, base.samples, targets, inner, width=WALL)
