"""Bones: rigid shafts, hinges between them, and aims; and ties across the drawn line.

A hinge costs κ |R_a(z_a) − R_b(z_b)|², R the motions of its shafts (`rigid_shafts`). The lengths of
bones are those between hinges, so they do not change, and the drawing at a joint is free. An aim
costs κ |R(z) − target|², and beyond an error e₀ = F / (2 κ) the part of Huber (1964) with the
constant force F. Both have the Hessian of Gauss and Newton; an aim beyond e₀ has the secant's.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import Complexes, Floats, Indices, readonly
from engine.deform.forces.bones import Aims, Hinge, Motions, Shaft, require_armature
from engine.deform.forces.rigid_shafts import TINY, RigidShafts
from engine.deform.forces.ties import Ties
from engine.deform.model.position_hessian import STIFFNESS, position_gram_matrix
from engine.deform.model.unknowns import by_unknowns
from engine.maps import Boundary

# κ of hinges and of aims, times L².
HINGE_STIFFNESS = 1.5e6
AIM_STIFFNESS = STIFFNESS


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Armature:
    """Shafts, hinges and ties of a shape.

    Build it with `Armature.place`. Its points (t,) are those of all shafts, and then of the ties.

    Parameters
    ----------
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

    shafts: RigidShafts
    hinges: Indices
    hinge_places: Complexes
    hinge_stiffness: Floats
    ties: Ties
    size: float
    coordinates: Complexes
    basis_coordinates: Complexes

    @classmethod
    def place(
        cls,
        boundary: Boundary,
        shafts: Sequence[Shaft],
        hinges: Sequence[Hinge] = (),
        ties: Ties | None = None,
    ) -> "Armature":
        """Place shafts, hinges and ties on a shape.

        Raises
        ------
        EngineError
            If all points of a shaft coincide, or a hinge names a shaft that does not exist.
        """
        require_armature(shafts, hinges)
        ties = Ties.none() if ties is None else ties
        placed = RigidShafts.place(shafts, boundary.size)
        ends = np.array([(hinge.first, hinge.second) for hinge in hinges], np.intp)
        places = np.array([(hinge.first_place, hinge.second_place) for hinge in hinges])
        coordinates = boundary.span.coordinates(np.concatenate([placed.points, ties.points]))
        return cls(
            shafts=placed,
            hinges=readonly(ends.reshape(-1, 2).T),
            hinge_places=readonly(places.reshape(-1, 2).T.astype(np.complex128)),
            hinge_stiffness=readonly(np.full(len(hinges), HINGE_STIFFNESS / boundary.size**2)),
            ties=ties,
            size=boundary.size,
            coordinates=readonly(coordinates),
            basis_coordinates=readonly(coordinates @ boundary.basis),
        )

    def softened(self, factor: float) -> "Armature":
        """Return the same armature with `factor` times the stiffness."""
        return replace(
            self,
            shafts=self.shafts.softened(factor),
            hinge_stiffness=readonly(factor * self.hinge_stiffness),
            ties=self.ties.softened(factor),
        )

    def hessian(self, boundary: Boundary) -> Floats:
        """Return the constant part (u, u) of the shafts' Hessian, that of κ Σ |f̂|²."""
        own, _ = self._split(self.basis_coordinates)
        rows = own - self.shafts.means(own)[self.shafts.owners]
        factors = np.sqrt(2.0 * self.shafts.stiffness[self.shafts.owners])
        return position_gram_matrix(boundary, factors[:, None] * rows)

    def motions(self, positions: Complexes) -> Motions:
        """Return the best rigid motions of the shafts with the points (t,) at these positions."""
        return self.shafts.motions(self._split(positions)[0])

    def energy(self, positions: Complexes, aims: Aims | None) -> float:
        """Return the energy of shafts, hinges, aims and ties."""
        motions = self.motions(positions)
        errors, stiffness, soft = self._errors(motions, aims)
        # Beyond e₀ the energy is κ e₀ (2 e − e₀), and the softened stiffness is κ e₀ / e.
        costs = soft * np.abs(errors) ** 2 * (2.0 - soft / stiffness)
        of_ties = self.ties.energy(self._split(positions)[1])
        return self.shafts.energy(motions) + float(costs.sum()) + of_ties

    def gradient(self, positions: Complexes, aims: Aims | None) -> Complexes:
        """Return the gradient of the energy at the points (t,)."""
        motions = self.motions(positions)
        errors, _, soft = self._errors(motions, aims)
        forces = 2.0 * np.concatenate([soft * errors.real, soft * errors.imag])
        of_shafts = self.shafts.gradient(motions) + forces @ self._functionals(motions, aims)
        return np.concatenate([of_shafts, self.ties.gradient(self._split(positions)[1])])

    def hessian_product(
        self, positions: Complexes, aims: Aims | None, changes: Complexes
    ) -> Complexes:
        """Return the product (t,) of the projected Hessian with changes of the points."""
        (_, ties), (own, others) = self._split(positions), self._split(changes)
        shafts = self.shafts
        product = 2.0 * shafts.stiffness[shafts.owners] * (own - shafts.means(own)[shafts.owners])
        for weights, sign in zip(self._weights(positions, aims), (1.0, -1.0), strict=True):
            product += sign * (weights.conj() @ own).real @ weights
        return np.concatenate([product, self.ties.hessian_product(ties, others)])

    def rows(
        self, boundary: Boundary, positions: Complexes, aims: Aims | None
    ) -> tuple[Floats, Floats]:
        """Return rows (…, u) whose Gram matrices are added to the constant Hessian, and removed."""
        of_shafts, of_ties = self._split(self.basis_coordinates)
        added, removed = self._weights(positions, aims)
        ties = self.ties.weights(self._split(positions)[1])
        joined = np.concatenate([_rows(boundary, added, of_shafts), _rows(boundary, ties, of_ties)])
        return joined, _rows(boundary, removed, of_shafts)

    def cut_aims(self, positions: Complexes, aims: Aims, most: float) -> tuple[Aims, bool]:
        """Return the aims with targets at most so far ahead, and whether any was farther."""
        ahead = -self.aim_errors(positions, aims)
        here = aims.targets - ahead
        cut = most / np.maximum(np.abs(ahead), most)
        return aims._replace(targets=here + cut * ahead), bool((cut < 1.0).any())

    def aim_errors(self, positions: Complexes, aims: Aims) -> Complexes:
        """Return how far the places of aims (a,) are from their targets."""
        return self._aim_errors(self.motions(positions), aims)

    def _split(self, values: Complexes) -> tuple[Complexes, Complexes]:
        """Return values of the points (t, …) for shafts and for ties."""
        count = len(self.shafts.points)
        return values[:count], values[count:]

    def _weights(self, positions: Complexes, aims: Aims | None) -> tuple[Complexes, Complexes]:
        """Return weights w of changes d of the shafts' points, for the squares of Re Σ conj(w) d.

        Those of the first array are added to the constant Hessian, those of the second removed.
        """
        motions = self.motions(positions)
        _, _, soft = self._errors(motions, aims)
        added = np.sqrt(2.0 * np.tile(soft, 2))[:, None] * self._functionals(motions, aims)
        return added, self.shafts.removed_weights(motions)

    def _errors(self, motions: Motions, aims: Aims | None) -> tuple[Complexes, Floats, Floats]:
        """Return the errors of hinges and aims, their κ, and κ softened to their largest force."""
        first, second = (
            self.shafts.carried(motions, shafts, places)
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
        moved = self.shafts.carried(motions, aims.shafts, aims.places, aims.are_places)
        return moved - aims.targets

    def _functionals(self, motions: Motions, aims: Aims | None) -> Complexes:
        """Return the weights of changes of the shafts' points in the errors of hinges and aims.

        Of shape (2 c, …): the real parts of all errors change by Re Σ conj(w) d, and the imaginary
        parts after them.
        """
        first, second = (
            self.shafts.functionals(motions, shafts, places)
            for shafts, places in zip(self.hinges, self.hinge_places, strict=True)
        )
        between = first - second
        if aims is not None:
            own = self.shafts.functionals(motions, aims.shafts, aims.places, aims.are_places)
            between = np.concatenate([between, own], axis=1)
        joined: Complexes = between.reshape(-1, len(self.shafts.points))
        return joined


def _rows(boundary: Boundary, weights: Complexes, basis_coordinates: Complexes) -> Floats:
    """Return the rows (…, u) of weights of changes of points."""
    return by_unknowns(boundary, weights.conj() @ basis_coordinates, weights @ basis_coordinates)
