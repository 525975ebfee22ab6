"""The few functions of time that represent a whole motion, found from a few of its points."""

from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.linalg import qr

from engine.arrays import Booleans, Floats, freeze
from engine.interpolation import chebyshev

DEGREES = (8, 16, 32)  # a step with any of these is short
# Largest number of pieces to try. The times left unresolved are computed directly.
MOST_ATTEMPTS = 256
OF_POLYNOMIALS = 0.1  # of the error allowed to the functions

Gap = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TimeFunctions:
    """Functions of time that are added to the linear blend of both keyframes.

    Attributes
    ----------
    series : chebyshev.PiecewiseSeries
        Scaled to a size of 1; linear in the gaps.
    gaps : tuple of Gap
        Pieces of time, in order, that no polynomial resolves.
    times : float64, shape (r,)
        Times that separate the r functions best; values there determine their coefficients.
    """

    series: chebyshev.PiecewiseSeries
    gaps: tuple[Gap, ...]
    times: Floats

    @classmethod
    def of(cls, probe: Callable[[Floats], Floats], tolerance: float) -> Generator[None, None, Self]:
        """Find functions that represent a probe's numbers (t, p) to a tolerance.

        Notes
        -----
        The probe is analytic in time but for some moments, so that a polynomial through Chebyshev
        nodes converges geometrically (`chebyshev.resolve_series`).
        """
        ends = probe(np.array([0.0, 1.0]))

        def added(times: Floats) -> Floats:
            return (probe(times) - np.column_stack([1.0 - times, times]) @ ends).T

        polynomials = OF_POLYNOMIALS * tolerance
        pieces = yield from chebyshev.resolve_series(
            added, tolerance=polynomials, degrees=DEGREES, most=MOST_ATTEMPTS
        )
        # A jump below the tolerance in the shortest piece is left out of the motion.
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
    """Return functions scaled to a size of 1, linear in gaps.

    The pieces beside a gap are therefore correct up to their ends.
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
