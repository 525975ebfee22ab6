"""Chebyshev series: what an analytic function of time is on a piece of it."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from engine.arrays import Floats, freeze

DEGREE = 24  # of the series of a piece of time
LAST_TERMS = 3
SURELY = 0.1  # of what may be left out
SHORTEST = 2.0**-30  # pieces of time are not halved below this


@cache
def nodes(degree: int) -> Floats:
    """Return the extrema (degree + 1,) of T_degree, from −1 to 1.

    Every other one of them is one of half the degree.
    """
    return freeze(chebyshev.chebpts2(degree + 1))


@cache
def to_coefficients(degree: int) -> Floats:
    """Return the matrix that takes the values at `nodes` to the coefficients of their series."""
    inverse = np.linalg.inv(chebyshev.chebvander(nodes(degree), degree))
    return freeze(np.asarray(inverse, dtype=np.float64))


def basis(x: float, count: int) -> Floats:
    """Return T_0 … T_(count − 1) at x in [−1, 1], (count,)."""
    # Several times faster than a recurrence in Python, and exact at both ends.
    values: Floats = np.cos(_orders(count) * math.acos(max(-1.0, min(1.0, x))))
    return values


@cache
def _orders(count: int) -> Floats:
    return freeze(np.arange(float(count)))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PiecewiseSeries:
    """Some functions of time as Chebyshev series on pieces of [0, 1].

    Parameters
    ----------
    breaks : float64, shape (b + 1,)
        Ends of the pieces, from 0 to 1.
    coefficients : float64, shape (b, n, j)
        Of T_0 … T_(n − 1) in each piece.
    """

    breaks: Floats
    coefficients: Floats

    def __call__(self, time: float) -> Floats:
        """Return the values (j,) at a time in [0, 1]."""
        last = len(self.breaks) - 2
        piece = min(int(np.searchsorted(self.breaks, time, side="right")) - 1, last)
        start, end = self.breaks[piece], self.breaks[piece + 1]
        coefficients = self.coefficients[piece]
        values: Floats = basis((2 * time - start - end) / (end - start), len(coefficients)) @ (
            coefficients
        )
        return values

    def at(self, times: Floats) -> Floats:
        """Return the values at times (s,), float64 (j, s)."""
        last = len(self.breaks) - 2
        pieces = np.minimum(np.searchsorted(self.breaks, times, side="right") - 1, last)
        start, end = self.breaks[pieces], self.breaks[pieces + 1]
        x = np.clip((2 * times - start - end) / (end - start), -1.0, 1.0)
        terms = np.cos(np.arange(self.coefficients.shape[1])[:, None] * np.arccos(x))
        values: Floats = np.einsum("ns,snj->js", terms, self.coefficients[pieces])
        return values


def one() -> PiecewiseSeries:
    """Return one function, which is 1 at all times."""
    return PiecewiseSeries(
        breaks=freeze(np.array([0.0, 1.0])), coefficients=freeze(np.ones((1, 1, 1)))
    )


def separate(
    values: Callable[[Floats], Floats],
    *,
    tolerance: float,
    left_out: float,
    shortest: float = SHORTEST,
    breaks: Sequence[float] = (0.0, 1.0),
    vanishing: bool = True,
) -> tuple[Floats, PiecewiseSeries]:
    """Write functions of time as sums of few forms times series.

    Parameters
    ----------
    values : callable
        Returns the functions at times (t,) in [0, 1], float64 (N, t).
    tolerance : float
        Of the last terms of the series.
    left_out : float
        The most that the forms which are left out add to the functions.
    shortest : float
        Piece of time that is not halved any more.
    breaks : sequence of float
        From 0 to 1: where the functions may have kinks.
    vanishing : bool
        Whether they are 0 at times 0 and 1, and the series made exactly so.

    Returns
    -------
    forms : float64, shape (N, j)
    series : PiecewiseSeries
        Of the j coefficients; the functions are `forms @ series(t)`.
    """
    x, every_other = nodes(DEGREE), to_coefficients(DEGREE // 2)
    pending = list(pairwise(breaks))[::-1]
    found, pieces = [0.0], []
    while pending:
        start, end = pending.pop()
        times = start + (end - start) * (1 + x) / 2
        # Half the degree mostly does, and its nodes serve the whole.
        found_at = values(times[::2])
        coefficients = np.zeros((len(found_at), DEGREE + 1))
        coefficients[:, : DEGREE // 2 + 1] = found_at @ every_other.T
        rest = np.abs(coefficients[:, DEGREE // 2 + 1 - LAST_TERMS : DEGREE // 2 + 1]).max()
        if rest > tolerance:
            both = np.empty_like(coefficients)
            both[:, ::2], both[:, 1::2] = found_at, values(times[1::2])
            coefficients = both @ to_coefficients(DEGREE).T
            rest = np.abs(coefficients[:, -LAST_TERMS:]).max()
        if rest <= tolerance or end - start <= shortest:
            found.append(end)
            pieces.append(coefficients)
        else:
            middle = (start + end) / 2
            pending += [(middle, end), (start, middle)]
    columns = np.hstack(pieces)
    # Where half the degree did, the other columns are 0.
    used = np.asarray(columns.any(axis=0))
    used[0] = True
    columns = columns[:, used]
    # The singular vectors of the triangle are those of the columns, and it is far smaller.
    _, sizes, functions = np.linalg.svd(np.linalg.qr(columns, mode="r"), full_matrices=False)
    rows = np.zeros((len(sizes), len(used)))
    rows[:, used] = sizes[:, None] * functions
    series = rows.reshape(len(sizes), len(pieces), DEGREE + 1)
    # Forms have the length 1, and no entry above: those that are surely left out are not formed.
    most = np.abs(series).sum(axis=2).max(axis=1)
    formed = max(1, int(np.count_nonzero(most[::-1].cumsum() > SURELY * left_out)))
    forms = columns @ functions[:formed].T
    forms /= np.maximum(sizes[:formed], np.finfo(np.float64).tiny)
    most[:formed] *= np.abs(forms).max(axis=0)
    kept = max(1, int(np.count_nonzero(most[::-1].cumsum() > left_out)))
    times, coefficients = np.array(found), series[:kept].transpose(1, 2, 0)
    if vanishing:
        coefficients = _vanishing_at_ends(times, coefficients)
    return forms[:, :kept], PiecewiseSeries(
        breaks=freeze(times), coefficients=freeze(np.ascontiguousarray(coefficients))
    )


def _vanishing_at_ends(breaks: Floats, coefficients: Floats) -> Floats:
    """Take off the rounding that is left at the keyframes, so that they come out exactly."""
    signs = (-1.0) ** np.arange(DEGREE + 1)
    first, last = signs @ coefficients[0], coefficients[-1].sum(axis=0)
    at_breaks = first + np.multiply.outer(breaks, last - first)
    corrected = coefficients.copy()
    corrected[:, 0] -= (at_breaks[1:] + at_breaks[:-1]) / 2
    corrected[:, 1] -= (at_breaks[1:] - at_breaks[:-1]) / 2
    return corrected
