"""The energy of an armature in a pose, with its derivatives.

An aim costs κ |R(z) − target|², and beyond an error e₀ = F / (2 κ) the part of Huber (1964) with
the constant force F. Hinges and aims have the Hessian of Gauss and Newton; an aim beyond e₀ has the
secant's.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.deform.forces.armature import Armature
from engine.deform.forces.bones import Aims, Motions
from engine.deform.forces.rigid_shafts import TINY
from engine.deform.forces.ties import TieCurvatures
from engine.deform.model.position_hessian import STIFFNESS
from engine.deform.model.unknowns import by_unknowns
from engine.maps import Boundary

# κ of aims, times L².
AIM_STIFFNESS = STIFFNESS


@dataclass(frozen=True, kw_only=True, eq=False)
class PosedArmature:
    """An armature with its points (t,) at these positions, and its aims.

    What several derivatives need is computed once.
    """

    armature: Armature
    positions: Complexes
    aims: Aims | None

    @property
    def energy(self) -> float:
        """The energy of shafts, hinges, aims and ties."""
        errors, stiffness, soft = self._errors
        # Beyond e₀ the energy is κ e₀ (2 e − e₀), and the softened stiffness is κ e₀ / e.
        costs = soft * np.abs(errors) ** 2 * (2.0 - soft / stiffness)
        of_ties = self.armature.ties.energy(self._ties)
        return self.armature.shafts.energy(self._motions) + float(costs.sum()) + of_ties

    @property
    def gradient(self) -> Complexes:
        """The gradient of the energy at the points (t,)."""
        errors, _, soft = self._errors
        forces = 2.0 * np.concatenate([soft * errors.real, soft * errors.imag])
        of_shafts = self.armature.shafts.gradient(self._motions) + forces @ self._functionals
        return np.concatenate([of_shafts, self.armature.ties.gradient(self._ties)])

    def hessian_product(self, changes: Complexes) -> Complexes:
        """Return the product (t,) of the projected Hessian with changes of the points."""
        shafts = self.armature.shafts
        own, others = self.armature.split(changes)
        product = 2.0 * shafts.point_stiffness * (own - shafts.means(own)[shafts.owners])
        for weights, sign in zip(self._weights, (1.0, -1.0), strict=True):
            # Re Σ conj(w) d is the plain product of the real and imaginary parts.
            along = weights.view(np.float64) @ own.view(np.float64)
            product += sign * (along @ weights)
        return np.concatenate([product, self._tie_curvatures.product(others)])

    def rows(self, boundary: Boundary) -> tuple[Floats, Floats]:
        """Return rows (…, u) whose Gram matrices are added to the constant Hessian, and removed."""
        of_shafts, of_ties = self.armature.split(self.armature.basis_coordinates)
        added, removed = self._weights
        ties = self._tie_curvatures.weights()
        joined = np.concatenate([_rows(boundary, added, of_shafts), _rows(boundary, ties, of_ties)])
        return joined, _rows(boundary, removed, of_shafts)

    @property
    def aim_errors(self) -> Complexes:
        """How far the places of the aims (a,) are from their targets."""
        errors: Complexes = self._errors[0][self.armature.hinges.shape[1] :]
        return errors

    def cut_aims(self, most: float) -> tuple[Aims | None, bool]:
        """Return the aims with targets at most so far ahead, and whether any was farther."""
        if (aims := self.aims) is None:
            return None, False
        ahead = -self.aim_errors
        cut = most / np.maximum(np.abs(ahead), most)
        targets = aims.targets - (1.0 - cut) * ahead
        return aims._replace(targets=targets), bool((cut < 1.0).any())

    @property
    def _ties(self) -> Complexes:
        return self.armature.split(self.positions)[1]

    @cached_property
    def _tie_curvatures(self) -> TieCurvatures:
        return self.armature.ties.curvatures(self._ties)

    @cached_property
    def _motions(self) -> Motions:
        return self.armature.motions(self.positions)

    @cached_property
    def _places(self) -> tuple[Indices, Complexes, Floats]:
        """The shafts, places and `are_places` of the hinges' first and second ends and the aims."""
        shafts, places = self.armature.hinges.ravel(), self.armature.hinge_places.ravel()
        if (aims := self.aims) is None:
            return shafts, places, np.ones(len(shafts))
        return (
            np.concatenate([shafts, aims.shafts]),
            np.concatenate([places, aims.places]),
            np.concatenate([np.ones(len(shafts)), aims.are_places]),
        )

    @cached_property
    def _errors(self) -> tuple[Complexes, Floats, Floats]:
        """The errors of hinges and aims, their κ, and κ softened to their largest force."""
        armature, aims = self.armature, self.aims
        moved = armature.shafts.carried(self._motions, *self._places)
        count, firm = len(armature.hinge_stiffness), armature.hinge_stiffness
        errors = moved[:count] - moved[count : 2 * count]
        if aims is None:
            return errors, firm, firm
        own = moved[2 * count :] - aims.targets
        stiffness = AIM_STIFFNESS * aims.weights / armature.size**2
        most = aims.max_forces / armature.size / np.maximum(2.0 * np.abs(own), TINY)
        return (
            np.concatenate([errors, own]),
            np.concatenate([firm, stiffness]),
            np.concatenate([firm, np.minimum(stiffness, most)]),
        )

    @cached_property
    def _functionals(self) -> Complexes:
        """The weights of changes of the shafts' points in the errors of hinges and aims.

        Of shape (2 c, …): the real parts of all errors change by Re Σ conj(w) d, and the imaginary
        parts after them.
        """
        shafts, count = self.armature.shafts, len(self.armature.hinge_stiffness)
        own = shafts.functionals(self._motions, *self._places)
        between = own[:, :count] - own[:, count : 2 * count]
        joined: Complexes = np.concatenate([between, own[:, 2 * count :]], axis=1)
        return joined.reshape(-1, len(shafts.points))

    @cached_property
    def _weights(self) -> tuple[Complexes, Complexes]:
        """Weights w of changes d of the shafts' points, for the squares of Re Σ conj(w) d.

        Those of the first array are added to the constant Hessian, those of the second removed.
        """
        _, _, soft = self._errors
        added = np.sqrt(2.0 * np.tile(soft, 2))[:, None] * self._functionals
        return added, self.armature.shafts.removed_weights(self._motions)


def _rows(boundary: Boundary, weights: Complexes, basis_coordinates: Complexes) -> Floats:
    """Return the rows (…, u) of weights of changes of points."""
    return by_unknowns(boundary, weights.conj() @ basis_coordinates, weights @ basis_coordinates)
