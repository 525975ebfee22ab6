"""Corrections of a segment at its times: without limits, at one time, and at all times."""

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from engine.arrays import Complexes, Floats
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
from engine.interpolation.added.pins.time_limits import CheckedTime, SolvedNode, keep_limits
from engine.interpolation.series.chebyshev import (
    PiecewiseSeries,
    chebyshev_nodes,
    to_coefficients,
)
from engine.maps import Bounds

DEGREE = 16  # of the series where limits act
# Distance of solved corrections from the limits, for what the series add between the solved times;
# how far keyframes at a limit are exceeded; and the distance at which the barrier begins.
INNER, BEYOND_KEYS, WALL = 0.01, 0.001, 0.001
# Number of pieces of a segment at whose ends its limits are kept, and of those at whose ends they
# are checked, the more closely if they could not be kept; and the slack at the first ones, for what
# happens between them.
CHECKED, CHECKED_AGAIN, CHECKED_CLOSELY, SLACK = 64, 128, 256, 2e-4


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


class SegmentSolver:
    """The corrections of a segment at its times, each solved once.

    `base_at` returns the base at a time in [0, 1]. The samples keep `bounds`, widened by the
    extremes of the keyframes.
    """

    def __init__(
        self,
        corrector: PointCorrector,
        base_at: Callable[[float], CorrectionBase],
        pins: SegmentPins,
        bounds: Bounds,
    ) -> None:
        self._corrector, self._pins = corrector, pins
        self._base_at = lru_cache(CHECKED + 1)(base_at)
        self._solved: dict[float, PointSolution] = {}
        ends = [extremes(corrector, self._base_at(time).samples) for time in (0.0, 1.0)]
        # Of ln σ_a, −ln σ_b and k, (3,): those of each time, and those near which a correction
        # is not analytic in time.
        self._limits = frame_limits(bounds, *(end + 2 * BEYOND_KEYS for end in ends))
        self._inner = frame_limits(bounds, *(end + BEYOND_KEYS for end in ends), inside=INNER)

    def solve(self, time: float) -> PointSolution:
        """Find the smallest correction at a time, from the nearest solved one, without limits."""
        if time not in self._solved:
            known = [other for other, each in self._solved.items() if each.is_finished]
            near = min(known, key=lambda other: abs(other - time), default=None)
            start = None if near is None else self._solved[near]
            nodes, targets = self._base_at(time).nodes, self._targets(time)
            self._solved[time] = solve_correction(
                self._corrector, nodes, targets, start, throw=False
            )
        return self._solved[time]

    def is_away(self, time: float) -> bool:
        """Return whether a solved correction converged and is away from the limits."""
        reached = extremes(self._corrector, self._base_at(time).samples, self._solved[time].x)
        away = bool((reached <= self._inner_at(time) - WALL).all())
        return away and self._solved[time].is_finished

    def solve_within_limits(self, time: float) -> PointSolution:
        """Find the correction at a single time."""
        found = self.solve(time)
        if self.is_away(time):
            return found
        checked, shares = [self._checked(time)], np.ones((1, 1))
        for solve in (self.solve, self._solve_walled):
            found = solve(time)
            if found.is_finished:
                node = self._node(time, found)
                (kept,), is_kept = keep_limits(self._corrector, [node], checked, shares)
                if is_kept:
                    return kept
        return found

    def solve_series_within_limits(self) -> tuple[dict[float, PointSolution], bool]:
        """Find corrections at Chebyshev nodes whose series keeps the limits between them, too.

        Pinned points stay where limits act elsewhere. If points are out of reach, corrections that
        keep the limits are solved first, each by itself. The second value tells whether the series
        keeps the limits.
        """
        times, nothing = chebyshev_times(DEGREE)[1:-1], self._corrector.variables.nothing
        checked = [self._checked(time) for time in chebyshev_times(CHECKED)]
        at_checked = 2 * np.array([each.time for each in checked]) - 1
        shares = chebyshev.chebvander(at_checked, DEGREE) @ to_coefficients(DEGREE)[:, 1:-1]
        for solve in (self.solve, self._solve_walled):
            found = [solve(time) for time in times]
            nodes = [self._node(*each) for each in zip(times, found, strict=True)]
            if solve == self.solve and not all(each.is_finished for each in found):
                continue
            kept, is_kept = keep_limits(self._corrector, nodes, checked, shares)
            if is_kept:
                found = kept
                break
        at_key = PointSolution(x=nothing, shift=0j, target_errors=np.zeros(0), steps=0)
        return {0.0: at_key, **dict(zip(times, found, strict=True)), 1.0: at_key}, is_kept

    def feasible_share(self, forms: Floats, series: PiecewiseSeries, *, is_kept: bool) -> float:
        """Return the share of a series that keeps the limits, also between the checked times."""
        share, few = 1.0, self._corrector.variables.at_samples.in_forms(forms)
        for time in chebyshev_times(CHECKED_AGAIN if is_kept else CHECKED_CLOSELY):
            x, samples = share * np.tile(series(time), 2), self._base_at(time).samples
            share *= max_feasible_share(few, samples, x, self._limits)
        return share

    def _solve_walled(self, time: float) -> PointSolution:
        base, inner = self._base_at(time), self._inner_at(time)
        targets = self._targets(time)
        return solve_within(self._corrector, base.nodes, base.samples, targets, inner, width=WALL)

    def _targets(self, time: float) -> PointTargets:
        base = self._base_at(time)
        return self._pins.targets(time, base.places, base.anchor)

    def _node(self, time: float, solution: PointSolution) -> SolvedNode:
        return SolvedNode(self._base_at(time).nodes, self._targets(time), solution)

    def _checked(self, time: float) -> CheckedTime:
        samples = self._base_at(time).samples
        own = extremes(self._corrector, samples) + INSIDE
        return CheckedTime(time, samples, np.maximum(self._limits, own) - SLACK)

    def _inner_at(self, time: float) -> Floats:
        own = extremes(self._corrector, self._base_at(time).samples) + WALL
        return np.maximum(self._inner, own)


def chebyshev_times(degree: int) -> list[float]:
    """Return Chebyshev nodes from 0 to 1."""
    times: list[float] = ((1.0 + chebyshev_nodes(degree)) / 2).tolist()
    return times
