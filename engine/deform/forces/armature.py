"""Bones: rigid shafts, hinges between them, and aims; and ties across the drawn line.

A hinge costs κ |R_a(z_a) − R_b(z_b)|², R the motions of its shafts (`rigid_shafts`). The lengths of
bones are those between hinges, so they do not change, and the drawing at a joint is free. The
energy in a pose and its derivatives are those of `posed_armature`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import Complexes, Floats, Indices, readonly
from engine.deform.forces.bones import Hinge, Motions, Shaft, require_armature
from engine.deform.forces.rigid_shafts import RigidShafts
from engine.deform.forces.ties import Ties
from engine.deform.model.position_hessian import position_gram_matrix
from engine.maps import Boundary

# κ of hinges, times L².
HINGE_STIFFNESS = 1.5e6


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
        own, _ = self.split(self.basis_coordinates)
        rows = own - self.shafts.means(own)[self.shafts.owners]
        factors = np.sqrt(2.0 * self.shafts.point_stiffness)
        return position_gram_matrix(boundary, factors[:, None] * rows)

    def motions(self, positions: Complexes) -> Motions:
        """Return the best rigid motions of the shafts with the points (t,) at these positions."""
        return self.shafts.motions(self.split(positions)[0])

    def split(self, values: Complexes) -> tuple[Complexes, Complexes]:
        """Return values of the points (t, …) for shafts and for ties."""
        count = len(self.shafts.points)
        return values[:count], values[count:]
