"""Chebyshev series: what an analytic function of time is on a piece of it."""

import math
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev

from engine.arrays import Floats, readonly


@cache
def nodes(degree: int) -> Floats:
    """Return the extrema (degree + 1,) of T_degree, from −1 to 1.

    Every other one of them is one of half the degree.
    """
    return readonly(chebyshev.chebpts2(degree + 1))


@cache
def to_coefficients(degree: int) -> Floats:
    """Return the matrix that takes the values at `nodes` to the coefficients of their series."""
    inverse = np.linalg.inv(chebyshev.chebvander(nodes(degree), degree))
    return readonly(np.asarray(inverse, dtype=np.float64))


def basis(x: float, count: int) -> Floats:
    """Return T_0 … T_(count − 1) at x in [−1, 1], (count,)."""
    # Several times faster than a recurrence in Python, and exact at both ends.
    values: Floats = np.cos(np.arange(count) * math.acos(max(-1.0, min(1.0, x))))
    return values
