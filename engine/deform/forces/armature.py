"""Bones: rigid shafts, hinges between them, and aims.

A shaft is a handful of points p of the drawing. Its energy is the misfit of the best rigid motion
R(z) = c + u z, |u| = 1,

    κ min Σ |f(p_i) − R(p_i)|² = κ (Σ |f̂_i|² + S − 2 |q|),  q = Σ conj(p̂_i) f̂_i,  S = Σ |p̂_i|²,

with p̂ and f̂ less their means; u = q / |q|. It names no place: its forces have no resultant and no
moment. The gradient at point i is 2 κ (f̂_i − u p̂_i). The Hessian is the constant one of κ Σ |f̂|²
less 2 κ S / |q| n nᵀ, n = i u p̂ / √S; with min(1/|q|, 1/S) it is positive, the exact projection.

R also moves places that are no point of the shaft, such as a joint. To first order

    dR(z) = mean d + i u (z − mean p) Im(conj(u) Σ conj(p̂_i) d_i) / |q|.

A hinge costs κ |R_a(z_a) − R_b(z_b)|². The lengths of bones are those between hinges, so they do
not change, and the drawing at a joint is free. An aim costs κ |R(z) − target|², and beyond an error
e₀ = F / (2 κ) the part of Huber (1964) with the constant force F. Both have the Hessian of Gauss
and Newton; an aim beyond e₀ has the secant's.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import Complexes, Floats, Indices, readonly
from engine.deform.forces.bones import Aims, Hinge, Motions, Shaft, require_armature
from engine.deform.model.position_hessian import STIFFNESS, position_gram_matrix
from engine.deform.model.unknowns import by_unknowns
from engine.maps import Boundary

# κ of hinges and of aims, times L².
HINGE_STIFFNESS = 3e5
AIM_STIFFNESS = STIFFNESS
TINY = 1e-300


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Armature:
    """Shafts and hinges of a shape.

    Build it with `Armature.place`.

    Parameters
    ----------
    points : complex128, shape (t,)
        Of all shafts.
    owners : intp, shape (t,)
        The number of each point's shaft.
    offsets : complex128, shape (t,)
        p̂ of each point.
    stiffness, squares, counts : float64, shape (s,)
        κ, S and the number of points of each shaft.
    centres : complex128, shape (s,)
        Mean of the rest of each shaft.
    hinges : intp, shape (2, j)
        The shafts of each hinge.
    hinge_places : complex128, shape (2, j)
        The hinge in the rest of both.
    hinge_stiffness : float64, shape (j,)
        κ of each.
    size : float
        L.
    coordinates, basis_coordinates : complex128, shape (t, n) and (t, r)
        As those of `Handles`.
    """

    points: Complexes
    owners: Indices
    offsets: Complexes
    stiffness: Floats
    squares: Floats
    counts: Floats
    centres: Complexes
    hinges: Indices
    hinge_places: Complexes
    hinge_stiffness: Floats
    size: float
    coordinates: Complexes
    basis_coordinates: Complexes

    @classmethod
    def place(
        cls, boundary: Boundary, shafts: Sequence[Shaft], hinges: Sequence[Hinge] = ()
    ) -> "Armature":
        """Place shafts and hinges on a shape.

        Raises
        ------
        EngineError
            If all points of a shaft coincide, or a hinge names a shaft that does not exist.
        """
        require_armature(shafts, hinges)
        counts = np.array([len(shaft.points) for shaft in shafts])
        points = np.concatenate([shaft.points for shaft in shafts]).astype(np.complex128)
        owners = np.repeat(np.arange(len(shafts), dtype=np.intp), counts)
        centres = np.array([shaft.rest.mean() for shaft in shafts], np.complex128)
        offsets = np.concatenate([shaft.rest for shaft in shafts]) - centres[owners]
        ends = np.array([(hinge.first, hinge.second) for hinge in hinges], np.intp)
        places = np.array([(hinge.first_place, hinge.second_place) for hinge in hinges])
        coordinates = boundary.span.coordinates(points)
        return cls(
            points=readonly(points),
            owners=readonly(owners),
            offsets=readonly(offsets),
            stiffness=readonly(np.array([s.stiffness for s in shafts]) / boundary.size**2),
            squares=readonly(np.asarray(np.bincount(owners, np.abs(offsets) ** 2), np.float64)),
            counts=readonly(counts.astype(np.float64)),
            centres=readonly(centres),
            hinges=readonly(ends.reshape(-1, 2).T),
            hinge_places=readonly(places.reshape(-1, 2).T.astype(np.complex128)),
            hinge_stiffness=readonly(np.full(len(hinges), HINGE_STIFFNESS / boundary.size**2)),
            size=boundary.size,
            coordinates=readonly(coordinates),
            basis_coordinates=readonly(coordinates @ boundary.basis),
        )

    def softened(self, factor: float) -> "Armature":
        """Return the same armature with `factor` times the stiffness."""
        return replace(
            self,
            stiffness=readonly(factor * self.stiffness),
            hinge_stiffness=readonly(factor * self.hinge_stiffness),
        )

    def hessian(self, boundary: Boundary) -> Floats:
        """Return the constant part (u, u) of the shafts' Hessian, that of κ Σ |f̂|²."""
        means = self._means(self.basis_coordinates)
        rows = self.basis_coordinates - means[self.owners]
        factors = np.sqrt(2.0 * self.stiffness[self.owners])
        return position_gram_matrix(boundary, factors[:, None] * rows)

    def motions(self, positions: Complexes) -> Motions:
        """Return the best rigid motions with the points (t,) at these positions."""
        means = self._means(positions)
        offsets = positions - means[self.owners]
        correlations = self._sums(self.offsets.conj() * offsets)
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

    def energy(self, positions: Complexes, aims: Aims | None) -> float:
        """Return the energy of shafts, hinges and aims."""
        motions = self.motions(positions)
        misfit = self._sums(np.abs(motions.offsets) ** 2).real + self.squares
        misfit -= 2.0 * np.abs(motions.correlations)
        errors, stiffness, soft = self._errors(motions, aims)
        # Beyond e₀ the energy is κ e₀ (2 e − e₀), and the softened stiffness is κ e₀ / e.
        costs = soft * np.abs(errors) ** 2 * (2.0 - soft / stiffness)
        return float(self.stiffness @ misfit + costs.sum())

    def gradient(self, positions: Complexes, aims: Aims | None) -> Complexes:
        """Return the gradient of the energy at the points (t,)."""
        motions = self.motions(positions)
        misfits = motions.offsets - motions.turns[self.owners] * self.offsets
        errors, _, soft = self._errors(motions, aims)
        forces = 2.0 * np.concatenate([soft * errors.real, soft * errors.imag])
        gradient: Complexes = 2.0 * self.stiffness[self.owners] * misfits
        return gradient + forces @ self._functionals(motions, aims)

    def hessian_product(
        self, positions: Complexes, aims: Aims | None, changes: Complexes
    ) -> Complexes:
        """Return the product (t,) of the projected Hessian with changes of the points."""
        motions = self.motions(positions)
        twice = 2.0 * self.stiffness[self.owners]
        product: Complexes = twice * (changes - self._means(changes)[self.owners])
        for weights, sign in zip(self.weights(motions, aims), (1.0, -1.0), strict=True):
            product += sign * (weights.conj() @ changes).real @ weights
        return product

    def rows(
        self, boundary: Boundary, positions: Complexes, aims: Aims | None
    ) -> tuple[Floats, Floats]:
        """Return rows (…, u) whose Gram matrices are added to the constant Hessian, and removed."""
        added, removed = (
            by_unknowns(
                boundary,
                weights.conj() @ self.basis_coordinates,
                weights @ self.basis_coordinates,
            )
            for weights in self.weights(self.motions(positions), aims)
        )
        return added, removed

    def weights(self, motions: Motions, aims: Aims | None) -> tuple[Complexes, Complexes]:
        """Return weights w (…, t) of changes d, for the squares of Re Σ conj(w) d.

        Those of the first array are added to the constant Hessian, those of the second removed.
        """
        _, _, soft = self._errors(motions, aims)
        added = np.sqrt(2.0 * np.tile(soft, 2))[:, None] * self._functionals(motions, aims)
        inverse = np.minimum(1.0 / np.maximum(np.abs(motions.correlations), TINY), 1 / self.squares)
        factors = np.sqrt(2.0 * self.stiffness * inverse) * 1j * motions.turns
        removed = self._is_of(np.arange(len(factors), dtype=np.intp)) * (
            factors[self.owners] * self.offsets
        )
        return added, removed

    def cut_aims(self, positions: Complexes, aims: Aims, most: float) -> tuple[Aims, bool]:
        """Return the aims with targets at most so far ahead, and whether any was farther."""
        ahead = -self.aim_errors(positions, aims)
        here = aims.targets - ahead
        cut = most / np.maximum(np.abs(ahead), most)
        return aims._replace(targets=here + cut * ahead), bool((cut < 1.0).any())

    def aim_errors(self, positions: Complexes, aims: Aims) -> Complexes:
        """Return how far the places of aims (a,) are from their targets."""
        return self._aim_errors(self.motions(positions), aims)

    def _errors(self, motions: Motions, aims: Aims | None) -> tuple[Complexes, Floats, Floats]:
        """Return the errors of hinges and aims, their κ, and κ softened to their largest force."""
        first, second = (
            self.carried(motions, shafts, places)
            for shafts, places in zip(self.hinges, self.hinge_places, strict=True)
        )
        errors, stiffness = first - second, self.hinge_stiffness
        if aims is None:
            return errors, stiffness, stiffness
        own = self._aim_errors(motions, aims)
        firm = AIM_STIFFNESS * aims.weights / self.size**2
        most = aims.max_forces / self.size / np.maximum(2.0 * np.abs(own), TINY)
        return (
            np.concatenate([errors, own]),
            np.concatenate([stiffness, firm]),
            np.concatenate([stiffness, np.minimum(firm, most)]),
        )

    def _aim_errors(self, motions: Motions, aims: Aims) -> Complexes:
        return self.carried(motions, aims.shafts, aims.places, aims.are_places) - aims.targets

    def _functionals(self, motions: Motions, aims: Aims | None) -> Complexes:
        """Return the weights of changes of the points in the errors of hinges and aims.

        Of shape (2 c, t): the real parts of all errors change by Re Σ conj(w) d, and the imaginary
        parts after them.
        """
        first, second = (
            self._functionals_of(motions, shafts, places)
            for shafts, places in zip(self.hinges, self.hinge_places, strict=True)
        )
        between = first - second
        if aims is not None:
            own = self._functionals_of(motions, aims.shafts, aims.places, aims.are_places)
            between = np.concatenate([between, own], axis=1)
        joined: Complexes = between.reshape(-1, len(self.points))
        return joined

    def _functionals_of(
        self,
        motions: Motions,
        shafts: Indices,
        places: Complexes,
        are_places: Floats | None = None,
    ) -> Complexes:
        """Return the weights (2, a, t) of changes in the real and imaginary parts of dR(z)."""
        held = np.ones(len(shafts)) if are_places is None else are_places
        arms = 1j * motions.turns[shafts] * (places - held * self.centres[shafts])
        arms /= np.maximum(np.abs(motions.correlations[shafts]), TINY)
        turned = 1j * motions.turns[self.owners] * self.offsets
        is_own = self._is_of(shafts)
        parts = [
            is_own * (unit * held[:, None] / self.counts[self.owners] + part[:, None] * turned)
            for unit, part in ((1.0, arms.real), (1j, arms.imag))
        ]
        return np.array(parts, np.complex128)

    def _is_of(self, shafts: Indices) -> Floats:
        """Return 1 where a point belongs to a shaft (a,), else 0, float64 (a, t)."""
        shares: Floats = (shafts[:, None] == self.owners).astype(np.float64)
        return shares

    def _sums(self, values: Complexes) -> Complexes:
        """Return the sums (s, …) of values of the points (t, …) of each shaft."""
        starts = np.searchsorted(self.owners, np.arange(len(self.counts)))
        sums: Complexes = np.add.reduceat(values, starts, axis=0)
        return sums

    def _means(self, values: Complexes) -> Complexes:
        sums = self._sums(values)
        means: Complexes = sums / self.counts.reshape(-1, *(1,) * (sums.ndim - 1))
        return means
