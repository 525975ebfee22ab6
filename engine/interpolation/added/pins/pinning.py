"""The corrections of a segment, solved at few times and written as series."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats, freeze
from engine.deform.correction import (
    BaseFrame,
    PointCorrector,
    PointSolution,
    extremes,
    frame_limits,
    max_feasible_share,
    solve_correction,
)
from engine.interpolation.added.pins.targets import SegmentPins
from engine.interpolation.series import PiecewiseSeries, constant_one, separate_variables
from engine.maps import Bounds

# Of the series and of what they leave out, where unknowns are about |h| and places over the size
# of the domain: some thousandths of a pixel of a thousand.
TOLERANCE, LEFT_OUT = 5e-6, 1e-6
SHORTEST = 2.0**-3  # pieces of time are not halved below this
DEGREES = (8, 16)


class CorrectionBase(NamedTuple):
    """An in-between that is to be corrected, at a time.

    Parameters
    ----------
    places, fz : complex128, shape (m,)
        At the handles.
    anchor : complex
    nodes, samples : BaseFrame
        At the nodes of the corrector's paths, and at the samples of the boundary.
    """

    places: Complexes
    fz: Complexes
    anchor: complex
    nodes: BaseFrame
    samples: BaseFrame


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CorrectionSeries:
    """h, q and a translation: few functions times series in time.

    Parameters
    ----------
    series : PiecewiseSeries
    h, q : complex128, shape (n, j)
        The functions in the domain's span.
    shifts : complex128, shape (j,)
        Of the translation.
    share : float
        The part of the correction that keeps the limits; 1 where all of it does.
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

    Parameters
    ----------
    corrector : PointCorrector
        For the handles.
    base_at : callable
        Returns the base at a time in [0, 1].
    pins : SegmentPins
    bounds : Bounds
        Limits that are kept at the samples, or those that the keyframes have beyond them.
    """
    known, size = corrector.variables, corrector.boundary.size
    solved: dict[float, PointSolution] = {}
    share = 1.0
    ends = [extremes(corrector, base_at(time).samples, known.nothing) for time in (0.0, 1.0)]
    limits = frame_limits(bounds, *ends)

    def at(time: float) -> Floats:
        nonlocal share
        base = base_at(time)
        targets = pins.targets(time, base.places, base.anchor)
        near = min(solved, key=lambda other: abs(other - time), default=None)
        start = None if near is None else solved[near]
        solved[time] = found = solve_correction(corrector, base.nodes, targets, start, throw=False)
        share = min(share, max_feasible_share(corrector, base.samples, found.x, limits))
        return np.append(found.x, [found.shift.real / size, found.shift.imag / size])

    def values(times: Floats) -> Floats:
        return np.array([at(time) for time in times.tolist()]).T

    forms, series = separate_variables(
        values, tolerance=TOLERANCE, left_out=LEFT_OUT, shortest=SHORTEST, degrees=DEGREES
    )
    # One share for all of the segment: a limit that is reached for a moment makes no jolt.
    forms *= share
    count = known.count
    return CorrectionSeries(
        series=series,
        h=freeze(known.h @ forms[:count]),
        q=freeze(known.q @ forms[count:-2]),
        shifts=freeze(size * (forms[-2] + 1j * forms[-1])),
        share=share,
    )
