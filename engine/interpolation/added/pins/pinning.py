"""The corrections of a segment, solved at few times and written as series."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats, freeze
from engine.deform.relative.correction import (
    BaseFrame,
    PointCorrector,
    PointSolution,
    extremes,
    largest_share,
    limits_of,
    solve,
)
from engine.interpolation.added.pins.targets import SegmentPins
from engine.interpolation.series import PiecewiseSeries, separate
from engine.maps import Bounds

# Of the series and of what they leave out, where unknowns are about |h| and places over the size
# of the domain: some thousandths of a pixel of a thousand.
TOLERANCE, LEFT_OUT = 5e-6, 1e-6
SHORTEST = 2.0**-3  # pieces of time are not halved below this
DEGREES = (8, 16)


class BaseAt(NamedTuple):
    """A segment's base at a time: at handles (m,), nodes (s,) and samples of the boundary (p,).

    Parameters
    ----------
    places : complex128, shape (m,)
    anchor : complex
    nodes, samples : BaseFrame
    """

    places: Complexes
    anchor: complex
    nodes: BaseFrame
    samples: BaseFrame


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PinSeries:
    """h, q and a translation of a segment: few functions times series in time.

    Parameters
    ----------
    series : PiecewiseSeries
    h, q : complex128, shape (n, j)
        The functions in the domain's span.
    shifts : complex128, shape (j,)
        Of the translation.
    sign : {-1, 1}
        Whether η or ν is kept where q = 0.
    is_squared : bool
        Whether K is L² / F, with L the exponential of the keyframes' blended logarithms; else L.
    share : float
        Which part of what the handles ask for keeps the limits; 1 where all of it does.
    """

    series: PiecewiseSeries
    h: Complexes
    q: Complexes
    shifts: Complexes
    sign: int
    is_squared: bool
    share: float

    def shift(self, times: Floats) -> Complexes:
        """Return the translation at times (t,)."""
        moved: Complexes = self.series.at(times).T @ self.shifts
        return moved


def pin(
    corrector: PointCorrector,
    base_at: Callable[[float], BaseAt],
    pins: SegmentPins,
    bounds: Bounds,
    *,
    sign: int,
    is_squared: bool,
) -> PinSeries:
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
    sign, is_squared
        As in `PinSeries`.
    """
    known, size = corrector.variables, corrector.boundary.size
    solved: dict[float, PointSolution] = {}
    nothing, share = np.zeros(2 * known.count), 1.0
    ends = [extremes(corrector, base_at(time).samples, nothing) for time in (0.0, 1.0)]
    limits = limits_of(bounds, *ends)

    def at(time: float) -> Floats:
        nonlocal share
        base = base_at(time)
        targets = pins.targets(time, base.places, base.anchor)
        near = min(solved, key=lambda other: abs(other - time), default=None)
        start = None if near is None else solved[near]
        solved[time] = found = solve(corrector, base.nodes, targets, start)
        share = min(share, largest_share(corrector, base.samples, found.x, limits))
        return np.append(found.x, [found.shift.real / size, found.shift.imag / size])

    def values(times: Floats) -> Floats:
        return np.array([at(time) for time in times.tolist()]).T

    forms, series = separate(
        values, tolerance=TOLERANCE, left_out=LEFT_OUT, shortest=SHORTEST, degrees=DEGREES
    )
    # One share for all of the segment: a limit that is reached for a moment makes no jolt.
    forms *= share
    count = known.count
    return PinSeries(
        series=series,
        h=freeze(known.h @ forms[:count]),
        q=freeze(known.q @ forms[count:-2]),
        shifts=freeze(size * (forms[-2] + 1j * forms[-1])),
        sign=sign,
        is_squared=is_squared,
        share=share,
    )
