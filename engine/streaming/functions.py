"""The few functions of time in which a whole motion is written, found at a few of its points."""

from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.linalg import qr

from engine.arrays import Booleans, Floats, freeze
from engine.interpolation import chebyshev

DEGREES = (8, 16, 32)  # a step at each of them is short
# Pieces that are tried. What is not resolved by then stays on the direct path.
MOST_ATTEMPTS = 256
OF_POLYNOMIALS = 0.1  # of what the functions may leave out in all

Gap = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TimeFunctions:
    """What is added to the linear blend of both keyframes, as functions of time.

    Parameters
    ----------
    series : chebyshev.PiecewiseSeries
        As large as 1; linear in the gaps.
    gaps : tuple of Gap
        Stretches of time, in order, that no polynomial resolves.
    times : float64, shape (r,)
        At which the r functions are told apart best: what they are multiplied by follows from
        values there.
    """

    series: chebyshev.PiecewiseSeries
    gaps: tuple[Gap, ...]
    times: Floats

    @classmethod
    def of(cls, probe: Callable[[Floats], Floats], tolerance: float) -> Generator[None, None, Self]:
        """Find the functions in which a probe's numbers (t, p) are written to a tolerance.

        Notes
        -----
        The probe is analytic in time but for some moments, so that a polynomial through Chebyshev
        nodes converges geometrically (`chebyshev.resolve`).
        """
        ends = probe(np.array([0.0, 1.0]))

        def added(times: Floats) -> Floats:
            return (probe(times) - np.column_stack([1.0 - times, times]) @ ends).T

        polynomials = OF_POLYNOMIALS * tolerance
        pieces = yield from chebyshev.resolve_series(
            added, tolerance=polynomials, degrees=DEGREES, most=MOST_ATTEMPTS
        )
        # What jumps by less than the tolerance within no time is none of the motion.
        pieces = [
            p if p.missing <= tolerance else p._replace(coefficients=0.0 * p.coefficients)
            for p in pieces
        ]
        yield
        _, found = chebyshev.compress_series(pieces, tolerance - polynomials, least=0)
        resolved = np.array([piece.missing <= tolerance for piece in pieces])
        series = _bridged(found, resolved)
        yield
        starts, lengths = series.breaks[:-1], np.diff(series.breaks)
        within = (1.0 + chebyshev.chebyshev_nodes(DEGREES[-1])) / 2
        times = np.unique((starts[:, None] + lengths[:, None] * within)[resolved])
        _, _, pivots = qr(series.at(times), mode="economic", pivoting=True)
        return cls(
            series=series,
            gaps=tuple((p.start, p.end) for p in pieces if p.missing > tolerance),
            times=freeze(np.sort(times[pivots[: series.coefficients.shape[2]]])),
        )


def _bridged(series: chebyshev.PiecewiseSeries, resolved: Booleans) -> chebyshev.PiecewiseSeries:
    """Return functions as large as 1, linear in gaps.

    So the pieces beside gaps are right up to their ends.
    """
    coefficients = series.coefficients / np.abs(series.coefficients).sum(axis=1).max(axis=0)
    signs = (-1.0) ** np.arange(coefficients.shape[1])
    ends = coefficients.sum(axis=1)
    before = 0.0 * ends[0]
    for i, is_known in enumerate(resolved):
        if not is_known:
            later = np.flatnonzero(resolved[i:])
            after = signs @ coefficients[i + later[0]] if len(later) else 0.0 * before
            coefficients[i, :2] = (before + after) / 2, (after - before) / 2
            ends[i] = after
        before = ends[i]
    return chebyshev.PiecewiseSeries(breaks=series.breaks, coefficients=freeze(coefficients))
