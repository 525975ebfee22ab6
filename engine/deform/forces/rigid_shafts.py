"""Rigid shafts: handfuls of points that stay as they are to each other.

The energy of a shaft with points p is the misfit of the best rigid motion R(z) = c + u z, |u| = 1,

    κ min Σ w_i |f(p_i) − R(p_i)|² = κ (Σ w_i |f̂_i|² + S − 2 |q|),

    q = Σ w_i conj(p̂_i) f̂_i,  S = Σ w_i |p̂_i|²,

with p̂ and f̂ less their weighted means; u = q / |q|. It names no place: its forces have no resultant
and no moment. The gradient at point i is 2 κ w_i (f̂_i − u p̂_i). The Hessian is the constant one of
κ Σ w |f̂|² less 2 κ S / |q| n nᵀ, n = i u w p̂ / √S; with min(1/|q|, 1/S) it is positive, the exact
projection.

R also moves places that are no point of the shaft, such as a joint. To first order

    dR(z) = mean d + i u (z − mean p) Im(conj(u) Σ w_i conj(p̂_i) d_i) / |q|.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, readonly
from engine.deform.forces.bones import Motions, Shaft

TINY = 1e-300


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RigidShafts:
    """Several shafts.

    Parameters
    ----------
    points : complex128, shape (t,)
        Of all shafts.
    owners : intp, shape (t,)
        The number of each point's shaft.
    starts : intp, shape (s,)
        The number of each shaft's first point.
    offsets, levers : complex128, shape (t,)
        p̂ and w p̂ of each point.
    weights : float64, shape (t,)
        w of each point.
    stiffness, squares, totals : float64, shape (s,)
        κ, S and Σ w of each shaft.
    centres : complex128, shape (s,)
        Mean of the rest of each shaft.
    """

    points: Complexes
    owners: Indices
    starts: Indices
    offsets: Complexes
    levers: Complexes
    weights: Floats
    stiffness: Floats
    squares: Floats
    totals: Floats
    centres: Complexes

    @classmethod
    def place(cls, shafts: Sequence[Shaft], size: float) -> Self:
        """Place shafts on a shape of size L."""
        counts = np.array([len(shaft.points) for shaft in shafts])
        owners = np.repeat(np.arange(len(shafts), dtype=np.intp), counts)
        shares = [np.broadcast_to(shaft.weights, len(shaft.points)) for shaft in shafts]
        totals = np.array([each.sum() for each in shares], np.float64)
        weights = np.concatenate(shares).astype(np.float64)
        rest = np.concatenate([shaft.rest for shaft in shafts]).astype(np.complex128)
        starts = np.cumsum(counts) - counts
        centres = np.add.reduceat(weights * rest, starts) / totals
        offsets = rest - centres[owners]
        points = np.concatenate([shaft.points for shaft in shafts]).astype(np.complex128)
        return cls(
            points=readonly(points),
            owners=readonly(owners),
            starts=readonly(starts),
            offsets=readonly(offsets),
            levers=readonly(weights * offsets),
            weights=readonly(weights),
            stiffness=readonly(np.array([s.stiffness for s in shafts]) / size**2),
            squares=readonly(np.add.reduceat(weights * np.abs(offsets) ** 2, starts)),
            totals=readonly(totals),
            centres=readonly(centres.astype(np.complex128)),
        )

    def softened(self, factor: float) -> Self:
        """Return the same shafts with `factor` times the stiffness."""
        return replace(self, stiffness=readonly(factor * self.stiffness))

    @property
    def point_stiffness(self) -> Floats:
        """κ w of each point, float64 (t,)."""
        stiffness: Floats = self.stiffness[self.owners] * self.weights
        return stiffness

    def motions(self, positions: Complexes) -> Motions:
        """Return the best rigid motions with the points (t,) at these positions."""
        means = self.means(positions)
        offsets = positions - means[self.owners]
        correlations = self._sums(self.levers.conj() * offsets)
        turns = correlations / np.maximum(np.abs(correlations), TINY)
        return Motions(offsets, means, correlations, turns)

    def carried(
        self,
        motions: Motions,
        shafts: Indices,
        places: Complexes,
        are_places: Floats | float = 1.0,
    ) -> Complexes:
        """Return where the motions of shafts (a,) bring places (a,) in their rest.

        Ways, where `are_places` is 0, only turn.
        """
        moved: Complexes = are_places * motions.means[shafts] + motions.turns[shafts] * (
            places - are_places * self.centres[shafts]
        )
        return moved

    def energy(self, motions: Motions) -> float:
        """Return the energy of the shafts."""
        misfit = self._sums(self.weights * np.abs(motions.offsets) ** 2).real + self.squares
        misfit -= 2.0 * np.abs(motions.correlations)
        return float(self.stiffness @ misfit)

    def gradient(self, motions: Motions) -> Complexes:
        """Return the gradient of the energy at the points (t,)."""
        misfits = motions.offsets - motions.turns[self.owners] * self.offsets
        gradient: Complexes = 2.0 * self.point_stiffness * misfits
        return gradient

    def removed_weights(self, motions: Motions) -> Complexes:
        """Return weights w (s, t): the squares of Re Σ conj(w) d that the Hessian lacks."""
        inverse = np.minimum(1.0 / np.maximum(np.abs(motions.correlations), TINY), 1 / self.squares)
        factors = np.sqrt(2.0 * self.stiffness * inverse) * 1j * motions.turns
        removed: Complexes = self._is_of(np.arange(len(factors), dtype=np.intp)) * (
            factors[self.owners] * self.levers
        )
        return removed

    def functionals(
        self,
        motions: Motions,
        shafts: Indices,
        places: Complexes,
        are_places: Floats,
    ) -> Complexes:
        """Return the weights (2, a, t) of changes in the real and imaginary parts of dR(z)."""
        arms = 1j * motions.turns[shafts] * (places - are_places * self.centres[shafts])
        arms /= np.maximum(np.abs(motions.correlations[shafts]), TINY)
        turned = 1j * motions.turns[self.owners] * self.levers
        is_own = self._is_of(shafts)
        means = are_places[:, None] * (self.weights / self.totals[self.owners])
        parts = np.empty((2, *is_own.shape), np.complex128)
        for part, unit, arm in zip(parts, (1.0, 1j), (arms.real, arms.imag), strict=True):
            part[:] = is_own * (unit * means + arm[:, None] * turned)
        return parts

    def means(self, values: Complexes) -> Complexes:
        """Return the weighted means (s, …) of values of the points (t, …) of each shaft."""
        others = (1,) * (values.ndim - 1)
        sums = self._sums(self.weights.reshape(-1, *others) * values)
        means: Complexes = sums / self.totals.reshape(-1, *others)
        return means

    def _is_of(self, shafts: Indices) -> Floats:
        """Return 1 where a point belongs to a shaft (a,), else 0, float64 (a, t)."""
        shares: Floats = (shafts[:, None] == self.owners).astype(np.float64)
        return shares

    def _sums(self, values: Complexes) -> Complexes:
        """Return the sums (s, …) of values of the points (t, …) of each shaft."""
        sums: Complexes = np.add.reduceat(values, self.starts, axis=0)
        return sums
