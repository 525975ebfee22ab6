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

    def hessian_product(self, positions: Complexes, changes: Complexes) -> Complexes:
        """Return the product (2 k,) of the Hessian with changes of the points."""
        directions, along, across = self._curvatures(positions)
        one, other = np.split(changes, 2)
        turned = directions.conj() * (one - other)
        pull = directions * (along * turned.real + 1j * across * turned.imag)
        return np.concatenate([pull, -pull])

    def weights(self, positions: Complexes) -> Complexes:
        """Return weights w (…, 2 k) of changes d: the Hessian is that of the squares of Re Σ w̄ d.

        Ties that are not stretched have none.
        """
        directions, along, across = self._curvatures(positions)
        is_stretched = np.flatnonzero(along)
        rows = np.zeros((2, len(is_stretched), 2, len(along)), np.complex128)
        own = np.arange(len(is_stretched))
        for row, turn, curvature in zip(rows, (1.0, 1j), (along, across), strict=True):
            pull = turn * directions[is_stretched] * np.sqrt(curvature[is_stretched])
            row[own, 0, is_stretched], row[own, 1, is_stretched] = pull, -pull
        joined: Complexes = rows.reshape(2 * len(is_stretched), 2 * len(along))
        return joined

    @property
    def _lengths(self) -> Floats:
        lengths: Floats = np.abs(self.starts - self.ends)
        return lengths

    def _stretched(self, positions: Complexes) -> tuple[Complexes, Floats, Floats]:
        """Return the ways d of the ties (k,), their lengths, and the excess e."""
        starts, ends = np.split(positions, 2)
        ways = starts - ends
        distances = np.maximum(np.abs(ways), np.finfo(np.float64).tiny)
        return ways, distances, np.maximum(distances / self._lengths - 1.0, 0.0)

    def _curvatures(self, positions: Complexes) -> tuple[Complexes, Floats, Floats]:
        """Return n of each tie, and the Hessian's parts along and across it."""
        ways, distances, excess = self._stretched(positions)
        along = 2.0 * self.stiffness / self._lengths**2 * (excess > 0)
        across = 2.0 * self.stiffness * excess / (self._lengths * distances)
        return ways / distances, along, across
