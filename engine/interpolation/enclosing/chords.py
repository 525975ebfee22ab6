"""Holomorphic functions along pieces of the boundary at one time: chords, and how far off.

With L̃ the chord of L, which is off by ε, e^L is off its own chord by at most

    max |e^L̃| (|ΔL|² / 8 + e^ε − 1),

as |e^L̃| is largest at an end and an eighth of the second derivative bounds what a chord lacks; and
the product of two chords is off the chord of the products by |ΔA| |ΔB| / 4. The reciprocal of L̃
is off its own chord by |ΔL|² / (4 m³), where |L̃| ≥ m, and changes by ε / (m (m − ε)) at most.
"""

from typing import Any, NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats
from engine.interpolation.enclosing.pieces import EdgeCurves


class Chord(NamedTuple):
    """A function along pieces (p,): its values at both ends, and how far it is off their chord.

    Parameters
    ----------
    first, last : complex128, shape (p,)
    error : float64, shape (p,)
        Infinite where nothing is known.
    """

    first: Complexes
    last: Complexes
    error: Floats

    @classmethod
    def of(cls, curves: EdgeCurves[Any], weights: Floats) -> Self:
        """Return the weighted sum of the keyframes' linear or quadratic curves."""
        used = weights != 0
        controls = np.einsum("q,pqb->pb", weights[used], curves.controls[:, used])
        first, last = controls[:, 0], controls[:, -1]
        # A Bézier curve is nearer to its chord than its middle control value, by half.
        bend = np.abs(controls[:, 1:-1] - (first + last)[:, None] / 2).sum(axis=1) / 2
        return cls(first, last, curves.errors[:, used] @ np.abs(weights[used]) + bend)

    @property
    def size(self) -> Floats:
        """The largest absolute value of the chord."""
        largest: Floats = np.maximum(np.abs(self.first), np.abs(self.last))
        return largest

    def plus(self, other: Self) -> Self:
        """Return the sum."""
        first, last, error = other
        return type(self)(self.first + first, self.last + last, self.error + error)

    def times(self, factor: complex | Complexes) -> Self:
        """Return a multiple, by one factor or one of each piece."""
        return type(self)(self.first * factor, self.last * factor, self.error * np.abs(factor))

    def product(self, other: Self) -> Self:
        """Return the product of both."""
        bend = np.abs(self.last - self.first) * np.abs(other.last - other.first) / 4
        error = self.size * other.error + other.size * self.error + self.error * other.error
        return type(self)(self.first * other.first, self.last * other.last, bend + error)

    def reciprocal(self) -> Self:
        """Return the reciprocal; nothing is known of it where it may be infinite."""
        change = np.abs(self.last - self.first)
        least = self.size - change
        clear = least > self.error
        m = np.where(clear, least, 1.0)
        error = change**2 / (4 * m**3) + self.error / (m * np.where(clear, m - self.error, 1.0))
        return type(self)(1 / self.first, 1 / self.last, np.where(clear, error, np.inf))

    def exponential(self) -> Self:
        """Return the exponential."""
        grown = type(self)(np.exp(self.first), np.exp(self.last), self.error)
        bend = np.abs(self.last - self.first) ** 2 / 8
        return grown._replace(error=grown.size * (bend + np.expm1(self.error)))
