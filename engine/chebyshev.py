"""Chebyshev series: what an analytic function of time is on a piece of it."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev

from engine.arrays import Floats, freeze


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
    values: Floats = np.cos(np.arange(count) * math.acos(max(-1.0, min(1.0, x))))
    return values


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
