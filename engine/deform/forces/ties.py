"""Ties across the drawn line: where a limb bends, its outline keeps its thickness.

A tie joins a point of the outline to a point a little inside. It is h long in the drawing and costs

    κ max(|f(p) − f(q)| / h − 1, 0)².

It resists stretch alone: on the inner side of a bend the drawing must give way. At a tie that is
longer by e h, with d = f(p) − f(q) and n = d / |d|, the gradient is 2 κ e n / h at p and its
opposite at q. The Hessian is 2 κ / h² along n and 2 κ e / (h |d|) across: it is never negative.
"""

from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats


class Ties(NamedTuple):
    """Ties between points of the drawing.

    Parameters
    ----------
    starts, ends : complex128, shape (k,)
    stiffness : float64, shape (k,)
        κ of each.
    """

    starts: Complexes
    ends: Complexes
    stiffness: Floats

    @classmethod
    def none(cls) -> "Ties":
        return cls(np.empty(0, np.complex128), np.empty(0, np.complex128), np.empty(0))

    @property
    def points(self) -> Complexes:
        """The starts and then the ends, (2 k,)."""
        return np.concatenate([self.starts, self.ends])

    def softened(self, factor: float) -> "Ties":
        """Return the same ties with `factor` times the stiffness."""
        return self._replace(stiffness=factor * self.stiffness)

    def energy(self, positions: Complexes) -> float:
        """Return the energy with the points (2 k,) at these positions."""
        _, _, excess = self._stretched(positions)
        return float(self.stiffness @ excess**2)

    def gradient(self, positions: Complexes) -> Complexes:
        """Return the gradient of the energy at the points (2 k,)."""
        ways, distances, excess = self._stretched(positions)
        pull = 2.0 * self.stiffness * excess / self._lengths * ways / distances
        return np.concatenate([pull, -pull])

    def curvatures(self, positions: Complexes) -> "TieCurvatures":
        """Return the Hessian of the energy with the points (2 k,) at these positions."""
        ways, distances, excess = self._stretched(positions)
        return TieCurvatures(
            directions=ways / distances,
            along=2.0 * self.stiffness / self._lengths**2 * (excess > 0),
            across=2.0 * self.stiffness * excess / (self._lengths * distances),
        )

    @property
    def _lengths(self) -> Floats:
        lengths: Floats = np.abs(self.starts - self.ends)
        return lengths

    def _stretched(self, positions: Complexes) -> tuple[Complexes, Floats, Floats]:
        """Return the ways d of the ties (k,), their lengths, and the excess e."""
        count = len(self.starts)
        ways = positions[:count] - positions[count:]
        distances = np.maximum(np.abs(ways), np.finfo(np.float64).tiny)
        return ways, distances, np.maximum(distances / self._lengths - 1.0, 0.0)


class TieCurvatures(NamedTuple):
    """The Hessian of ties in a pose.

    Parameters
    ----------
    directions : complex128, shape (k,)
        n of each tie.
    along, across : float64, shape (k,)
        The parts along and across it.
    """

    directions: Complexes
    along: Floats
    across: Floats

    def product(self, changes: Complexes) -> Complexes:
        """Return the product (2 k,) with changes of the points."""
        count = len(self.directions)
        turned = self.directions.conj() * (changes[:count] - changes[count:])
        pull = self.directions * (self.along * turned.real + 1j * self.across * turned.imag)
        return np.concatenate([pull, -pull])

    def weights(self) -> Complexes:
        """Return weights w (…, 2 k) of changes d: the Hessian is that of the squares of Re Σ w̄ d.

        Ties that are not stretched have none.
        """
        is_stretched = np.flatnonzero(self.along)
        rows = np.zeros((2, len(is_stretched), 2, len(self.along)), np.complex128)
        own = np.arange(len(is_stretched))
        for row, turn, curvature in zip(rows, (1.0, 1j), (self.along, self.across), strict=True):
            pull = turn * self.directions[is_stretched] * np.sqrt(curvature[is_stretched])
            row[own, 0, is_stretched], row[own, 1, is_stretched] = pull, -pull
        joined: Complexes = rows.reshape(2 * len(is_stretched), 2 * len(self.along))
        return joined
