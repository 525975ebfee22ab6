"""Chebyshev series: an analytic function of time on pieces of time."""

import math
from collections import deque
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from math import inf
from operator import attrgetter
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.polynomial import chebyshev

from engine.arrays import Floats, freeze

Result = TypeVar("Result")

DEGREES = (12, 24)  # of the series of a piece of time; half the degree usually suffices
LAST_TERMS = 3
HOPE = 10.0  # times the tolerance: the next degree is tried if the expected error is below
SURELY = 0.1  # of `left_out`
SHORTEST = 2.0**-30  # pieces of time are not halved below this


@cache
def chebyshev_nodes(degree: int) -> Floats:
    """Return the extrema (degree + 1,) of T_degree, from −1 to 1.

    Every second extremum is an extremum for half the degree.
    """
    return freeze(chebyshev.chebpts2(degree + 1))


@cache
def to_coefficients(degree: int) -> Floats:
    """Return the matrix from values at `chebyshev_nodes` to the coefficients of the series."""
    inverse = np.linalg.inv(chebyshev.chebvander(chebyshev_nodes(degree), degree))
    return freeze(np.asarray(inverse, dtype=np.float64))


def chebyshev_basis(x: float, count: int) -> Floats:
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

    `breaks` (b + 1,) are the ends of the pieces, from 0 to 1. `coefficients` (b, n, j) are those of
    T_0 … T_(n − 1) in each piece.
    """

    breaks: Floats
    coefficients: Floats

    def __call__(self, time: float) -> Floats:
        """Return the values (j,) at a time in [0, 1]."""
        last = len(self.breaks) - 2
        piece = min(int(np.searchsorted(self.breaks, time, side="right")) - 1, last)
        start, end = self.breaks[piece], self.breaks[piece + 1]
        coefficients = self.coefficients[piece]
        values: Floats = chebyshev_basis(
            (2 * time - start - end) / (end - start), len(coefficients)
        ) @ (coefficients)
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


def constant_one() -> PiecewiseSeries:
    """Return one function that is 1 at all times."""
    return PiecewiseSeries(
        breaks=freeze(np.array([0.0, 1.0])), coefficients=freeze(np.ones((1, 1, 1)))
    )


class Resolved(NamedTuple):
    """Functions of time on a piece of time.

    `coefficients` (N, n) are those of T_0 … T_(n − 1). `missing` is the largest of the last terms,
    an estimate of the truncation error.
    """

    start: float
    end: float
    coefficients: Floats
    missing: float


def resolve_series(
    values: Callable[[Floats], Floats],
    *,
    tolerance: float,
    degrees: tuple[int, ...] = DEGREES,
    breaks: Sequence[float] = (0.0, 1.0),
    shortest: float = SHORTEST,
    most: float = inf,
) -> Generator[None, None, list[Resolved]]:
    """Write functions of time as series on pieces, halved until the last terms are small.

    The caller may leave the generator after each evaluation.

    Parameters
    ----------
    values : callable
        Returns the functions at times (t,) in [0, 1], float64 (N, t).
    tolerance : float
        Limit of the last terms.
    degrees : tuple of int
        Degrees to try. Each is twice the previous one and reuses its nodes.
    breaks : sequence of float
        Times from 0 to 1 at which the functions may have kinks.
    shortest : float
        Shorter pieces of time are not halved.
    most : float
        Largest number of pieces to try.

    Returns
    -------
    list of Resolved
        In the order of time; `missing` is above the tolerance in unresolved pieces.
    """
    # The longest piece first: easy pieces are finished before hard pieces use up all attempts.
    pending, found, tried = deque(pairwise(breaks)), [], 0
    while pending and tried < most:
        tried += 1
        piece = yield from _tried(values, *pending.popleft(), tolerance, degrees)
        if piece.missing <= tolerance or piece.end - piece.start <= shortest:
            found.append(piece)
        else:
            middle = (piece.start + piece.end) / 2
            pending += [(piece.start, middle), (middle, piece.end)]
    found += [Resolved(*gap, 0.0 * piece.coefficients, inf) for gap in pending]
    return sorted(found, key=attrgetter("start"))


def _tried(
    values: Callable[[Floats], Floats],
    start: float,
    end: float,
    tolerance: float,
    degrees: tuple[int, ...],
) -> Generator[None, None, Resolved]:
    """Write functions of time as series on one piece, with the lowest sufficient degree."""
    at_nodes, before = None, inf
    for degree in degrees:
        times = start + (end - start) * (1.0 + chebyshev_nodes(degree)) / 2
        if at_nodes is None:
            at_nodes = values(times)
        else:
            between = values(times[1::2])
            known, at_nodes = at_nodes, np.empty((len(between), degree + 1))
            at_nodes[:, ::2], at_nodes[:, 1::2] = known, between
        yield
        coefficients = at_nodes @ to_coefficients(degree).T
        missing = float(np.abs(coefficients[:, -LAST_TERMS:]).max(initial=0.0))
        # If the terms fall at the same rate, the next degree multiplies them by the squared ratio.
        if missing <= tolerance or not missing * (missing / before) ** 2 <= HOPE * tolerance:
            break
        before = missing
    return Resolved(start, end, coefficients, missing)


def separate_variables(
    values: Callable[[Floats], Floats],
    *,
    tolerance: float,
    left_out: float,
    shortest: float = SHORTEST,
    breaks: Sequence[float] = (0.0, 1.0),
    vanishing: bool = True,
    degrees: tuple[int, ...] = DEGREES,
) -> tuple[Floats, PiecewiseSeries]:
    """Write functions of time as sums of few forms times series.

    Parameters
    ----------
    values, tolerance, shortest, breaks, degrees
        As in `resolve_series`.
    left_out : float
        Largest sum of the omitted terms.
    vanishing : bool
        Whether the functions are 0 at times 0 and 1. Then the series are made exactly 0 there.

    Returns
    -------
    forms : float64, shape (N, j)
    series : PiecewiseSeries
        Series of the j coefficients; the functions are `forms @ series(t)`.
    """
    pieces = finish(
        resolve_series(
            values, tolerance=tolerance, degrees=degrees, breaks=breaks, shortest=shortest
        )
    )
    forms, series = compress_series(pieces, left_out)
    if vanishing:
        coefficients = freeze(_vanishing_at_ends(series.breaks, series.coefficients))
        series = replace(series, coefficients=coefficients)
    return forms, series


def compress_series(
    pieces: Sequence[Resolved], left_out: float, *, least: int = 1
) -> tuple[Floats, PiecewiseSeries]:
    """Write resolved functions as sums of at least `least` forms (N, j) times series.

    The omitted terms sum up to at most `left_out`.
    """
    count = max(piece.coefficients.shape[1] for piece in pieces)
    padded = np.zeros((len(pieces), count, len(pieces[0].coefficients)))
    for row, piece in zip(padded, pieces, strict=True):
        row[: piece.coefficients.shape[1]] = piece.coefficients.T
    rows = padded.reshape(-1, padded.shape[2])
    # In a piece of a lower degree the other rows are 0.
    used = np.asarray(rows.any(axis=1))
    used[0] = True
    columns = rows[used].T
    # The triangle R of a QR decomposition has the singular vectors of the columns, and is far
    # smaller. (A Gram matrix would lose half the digits.)
    _, sizes, functions = np.linalg.svd(np.linalg.qr(columns, mode="r"), full_matrices=False)
    spread = np.zeros((len(sizes), len(used)))
    spread[:, used] = sizes[:, None] * functions
    series = spread.reshape(len(sizes), len(pieces), count)
    # Forms have length 1, so no entry above 1. Forms that are certainly omitted are not computed.
    most = np.abs(series).sum(axis=2).max(axis=1)
    formed = max(1, int(np.count_nonzero(most[::-1].cumsum() > SURELY * left_out)))
    forms = columns @ functions[:formed].T
    forms /= np.maximum(sizes[:formed], np.finfo(np.float64).tiny)
    most[:formed] *= np.abs(forms).max(axis=0)
    kept = max(least, int(np.count_nonzero(most[::-1].cumsum() > left_out)))
    coefficients = np.ascontiguousarray(series[:kept].transpose(1, 2, 0))
    breaks = np.array([0.0, *(piece.end for piece in pieces)])
    return forms[:, :kept], PiecewiseSeries(
        breaks=freeze(breaks), coefficients=freeze(coefficients)
    )


def finish(steps: Generator[None, None, Result]) -> Result:
    """Run a generator to its end, and return its result."""
    while True:
        try:
            next(steps)
        except StopIteration as stop:
            result: Result = stop.value
            return result


def _vanishing_at_ends(breaks: Floats, coefficients: Floats) -> Floats:
    """Remove the rounding errors at times 0 and 1, so that the keyframes are exact."""
    signs = (-1.0) ** np.arange(coefficients.shape[1])
    first, last = signs @ coefficients[0], coefficients[-1].sum(axis=0)
    at_breaks = first + np.multiply.outer(breaks, last - first)
    corrected = coefficients.copy()
    corrected[:, 0] -= (at_breaks[1:] + at_breaks[:-1]) / 2
    corrected[:, 1] -= (at_breaks[1:] - at_breaks[:-1]) / 2
    return corrected
