"""The objective of a step: energy, barrier and handles, with the gradient.

The unknowns are φ and ψ in the boundary's basis, whose derivatives are orthonormal and whose means
are 0. The Hessian is then well conditioned except next to bounds, and single precision suffices for
all other samples. ψ_0, a constant, is no unknown (the gauge: (φ + c, ψ − conj(c)) is the same map).
As a real vector they are the real and imaginary parts, alternating, of the conjugates of φ and ψ_1,
ψ_2, …. In this order Re Σ P_j φ_j is the plain product with the parts of a complex row P, and
matrices need no rearrangement.

Around q holes the last q entries of φ are the logarithms' a_j, scaled, and those of ψ their
conjugates: ψ's are no unknowns, and their contributions are folded onto φ's. Constants on the cage
of a hole, which change no map, have a stiffness of their own (`Handles`), and steps never change
them. In all there are u = 4 r − 2 − 2 q real unknowns for the r functions of the basis.
"""

from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from weakref import WeakKeyDictionary

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.deform.forces.posed_armature import PosedArmature
from engine.deform.handles import Handles, HandleTargets
from engine.deform.model.barrier import Barrier
from engine.deform.model.energy import RadialDerivatives, symmetric_dirichlet_derivatives
from engine.deform.model.evaluation import Evaluation
from engine.deform.model.unknowns import by_unknowns, in_basis
from engine.maps import Boundary


@dataclass(frozen=True, kw_only=True, eq=False)
class Objective:
    """Energy + barrier + handle terms.

    Parameters
    ----------
    secant : bool
        Whether pulls with slack are as stiff along their direction as across, where the Hessian is
        0: steps then lead no farther than to their targets.
    """

    boundary: Boundary
    handles: Handles
    targets: HandleTargets
    barrier: Barrier | None = None
    secant: bool = False

    @cached_property
    def rotation_constraints(self) -> Booleans:
        """Which handles have a prescribed rotation, bool (h,)."""
        return np.isfinite(self.targets.rotations)

    def coefficients(self, unknowns: Floats) -> tuple[Complexes, Complexes]:
        """Return the columns (n,) of coefficients of φ and ψ for unknowns (u,)."""
        of_phi, of_psi = in_basis(self.boundary, unknowns)
        return self.boundary.basis @ of_phi, self.boundary.basis @ of_psi

    def evaluate_change(self, unknowns: Floats) -> Evaluation:
        """Evaluate a change of a map by its unknowns (u,)."""
        of_phi, of_psi = in_basis(self.boundary, unknowns)
        rows, coordinates = self.boundary.basis_derivatives, self.handles.basis_coordinates
        return Evaluation(
            f=rows @ of_phi,
            g=rows @ of_psi,
            positions=coordinates @ of_phi + (coordinates @ of_psi).conj(),
            fz=self.handles.basis_derivatives @ of_phi,
            shaft_positions=self._at_shafts(of_phi, of_psi, in_basis=True),
        )

    def evaluate(self, phi: Complexes, psi: Complexes) -> Evaluation:
        """Evaluate a map, or a change of a map, by the columns (n,) of its coefficients."""
        span, coordinates = self.boundary.span, self.handles.coordinates
        rows, phi_alone = self.boundary.derivatives, span.without_constant(phi)
        return Evaluation(
            f=rows @ phi_alone,
            g=rows @ span.without_constant(psi),
            positions=coordinates @ phi + (coordinates @ psi).conj(),
            fz=self.handles.derivatives @ phi_alone,
            shaft_positions=self._at_shafts(phi, psi, in_basis=False),
        )

    def _at_shafts(self, phi: Complexes, psi: Complexes, *, in_basis: bool) -> Complexes:
        """Return the positions (t,) of the shafts' points for coefficients of φ and ψ."""
        armature = self.handles.armature
        if armature is None:
            return np.empty(0, np.complex128)
        coordinates = armature.basis_coordinates if in_basis else armature.coordinates
        positions: Complexes = coordinates @ phi + (coordinates @ psi).conj()
        return positions

    def value(self, jet: Evaluation) -> float:
        """Return the objective, ∞ where the map folds or leaves the bounds."""
        value = self.energy(jet)
        if self.barrier is not None and np.isfinite(value):
            density = self.barrier.value(jet.a, jet.b)
            value += float(self.boundary.barrier_weights @ density)
        return value

    def energy(self, jet: Evaluation) -> float:
        """Return the objective without its barrier."""
        with np.errstate(over="ignore", invalid="ignore"):
            errors = self.targets.target_errors(jet.positions)
            value = self.boundary.weights @ jet.density
            value += np.vdot(errors, self.handles.stiffness * errors).real
            if self.targets.pulls is not None:
                lacking = jet.positions - self.targets.positions
                value += self.targets.pulls.slack_energy(self.targets.pulls.slack(lacking))
            if (armature := self.armature_at(jet)) is not None:
                value += armature.energy
            if self.rotation_constraints.any():
                value += self.rotation_stiffness @ self.rotation_errors(jet) ** 2
        return np.inf if np.isnan(value) else float(value)

    def target_error(self, jet: Evaluation) -> float:
        """Return the root mean square distance of handles and aims from their targets, over L."""
        errors = jet.positions - self.targets.positions
        if (armature := self.armature_at(jet)) is not None:
            errors = np.concatenate([errors, armature.aim_errors])
        squares = np.vdot(errors, errors).real / max(len(errors), 1)
        return sqrt(squares) / self.boundary.size

    def is_within(self, jet: Evaluation) -> bool:
        """Whether the samples are strictly within the bounds."""
        if self.barrier is None:
            return bool((jet.a > jet.b).all())
        return bool(self.barrier.slacks(jet.a, jet.b).min() > 0)

    def radial_derivatives(self, jet: Evaluation) -> RadialDerivatives:
        """Return each sample's contribution to the derivatives of energy and barrier."""
        a, b = jet.a, jet.b
        energy = symmetric_dirichlet_derivatives(a, b).weighted(self.boundary.weights)
        if self.barrier is None:
            return energy
        return energy.plus(self.barrier.derivatives(a, b).weighted(self.boundary.barrier_weights))

    def gradient(self, jet: Evaluation, radial: RadialDerivatives) -> Floats:
        """Return the gradient (u,)."""
        gradient: Floats = self.held_gradient(jet)
        return gradient + self.sampled_gradient(jet, radial.a, radial.b_per_b)

    def held_gradient(self, jet: Evaluation) -> Floats:
        """Return the gradient (u,) of the energy of handles and armature."""
        pull = 2.0 * self.handles.stiffness * self.targets.target_errors(jet.positions)
        by_phi = pull.conj() @ self.handles.basis_coordinates
        by_psi = pull @ self.handles.basis_coordinates
        if (armature := self.armature_at(jet)) is not None:
            pull, coordinates = armature.gradient, armature.armature.basis_coordinates
            by_phi += pull.conj() @ coordinates
            by_psi += pull @ coordinates
        if self.rotation_constraints.any():
            # d arg F = Im(dF / F) = Re(−i dF / F).
            angle = 2.0 * self.rotation_stiffness * self.rotation_errors(jet)
            by_phi += (-1j * angle / jet.fz[self.rotation_constraints]) @ self.rotation_rows
        return self.by_unknowns(by_phi, by_psi)

    def target_error_change(self, jet: Evaluation, changes: Complexes) -> Complexes:
        """Return the first-order changes of the target errors (h,) after the handles moved."""
        hands = self.targets.pulls
        if hands is None:
            return changes
        directions, across = hands.slack_directions(jet.positions - self.targets.positions)
        along = across if self.secant else 1.0
        moves = directions.conj() * (hands.weights @ changes)
        given = directions * (along * moves.real + 1j * across * moves.imag)
        return changes - hands.spread_to_handles(given)

    def pull_rows(self, jet: Evaluation) -> Floats:
        """Return the rows (s, u) whose Gram matrix pulls subtract from the handles' Hessian."""
        hands = self.targets.pulls
        if hands is None:
            return np.empty((0, len(self.handles.hessian)))
        directions, across = hands.slack_directions(jet.positions - self.targets.positions)
        rows = []
        for hand in np.flatnonzero(across):
            means = hands.weights[hand] @ self.handles.basis_coordinates
            stiffness, share = 2.0 * hands.stiffness[hand], across[hand]
            for turn, part in ((1.0, share if self.secant else 1.0), (1.0j, share)):
                pull = turn * directions[hand] * np.sqrt(stiffness * part)
                rows.append(self.by_unknowns(pull.conj() * means, pull * means))
        return np.array(rows).reshape(-1, len(self.handles.hessian))

    def armature_rows(self, jet: Evaluation) -> tuple[Floats, Floats]:
        """Return the rows (s, u) whose Gram matrices the armature adds and subtracts."""
        if (armature := self.armature_at(jet)) is None:
            none = np.empty((0, len(self.handles.hessian)))
            return none, none
        return armature.rows(self.boundary)

    def armature_at(self, jet: Evaluation) -> PosedArmature | None:
        """Return the armature in the pose of a map."""
        armature = self.handles.armature
        if armature is None:
            return None
        if jet not in self._posed_armatures:
            self._posed_armatures[jet] = PosedArmature(
                armature=armature, positions=jet.shaft_positions, aims=self.targets.aims
            )
        return self._posed_armatures[jet]

    @cached_property
    def _posed_armatures(self) -> WeakKeyDictionary[Evaluation, PosedArmature]:
        return WeakKeyDictionary()

    def sampled_gradient(
        self, jet: Evaluation, by_a: Floats, b_per_b: Floats, samples: Indices | slice = slice(None)
    ) -> Floats:
        """Return the gradient (u,) of a sum over samples of functions of a and b.

        Parameters
        ----------
        by_a, b_per_b : float64, shape (m,)
            Each sample's derivative by a, and its derivative by b over b.
        samples : Indices or slice
            Contributing samples, by default all.
        """
        rows, f, g = self.boundary.basis_derivatives[samples], jet.f[samples], jet.g[samples]
        by_phi = (by_a[samples] / jet.a[samples] * f.conj()) @ rows
        by_psi = (b_per_b[samples] * g.conj()) @ rows
        return self.by_unknowns(by_phi, by_psi)

    def by_unknowns(self, by_phi: Complexes, by_psi: Complexes) -> Floats:
        """Return a gradient (u,) from the factors of φ and ψ (r,), logarithms included."""
        return by_unknowns(self.boundary, by_phi, by_psi)

    @cached_property
    def rotation_stiffness(self) -> Floats:
        """Cost of a rotation of each handle with a prescribed rotation, float64 (t,)."""
        return 2.0 * self.handles.lever**2 * self.handles.stiffness[self.rotation_constraints]

    @cached_property
    def rotation_rows(self) -> Complexes:
        """The derivatives of the basis at these handles, complex128 (t, r)."""
        return self.handles.basis_derivatives[self.rotation_constraints]

    def rotation_errors(self, jet: Evaluation) -> Floats:
        """Return the rotation errors of these handles in radians, float64 (t,)."""
        back = np.exp(-1j * self.targets.rotations[self.rotation_constraints])
        angles: Floats = np.angle(jet.fz[self.rotation_constraints] * back)
        return angles

    def rotation_frames(self, jet: Evaluation, *, removed: bool = False) -> list[Complexes]:
        """Return the factors of dF of handles in rows: the projected Hessian of their rotations.

        With dF / F = x + iy the term c δ² has the Hessian 2c [[0, −δ], [−δ, 1]]; its eigenvalues
        are c (1 ± root) with root² = 1 + 4 δ², for the vectors (−2δ, 1 ± root). The projection
        removes the negative one.
        """
        if not self.rotation_constraints.any():
            return []
        delta = self.rotation_errors(jet)
        root = np.sqrt(1.0 + 4.0 * delta**2)
        eigenvalue = 1.0 - root if removed else 1.0 + root
        # x vx + y vy = Re((vx − i vy) dF / F).
        length = np.maximum(np.hypot(2.0 * delta, eigenvalue), np.finfo(np.float64).tiny)
        scale = np.sqrt(self.rotation_stiffness * np.abs(eigenvalue)) / length
        return [scale * (-2.0 * delta - 1j * eigenvalue) / jet.fz[self.rotation_constraints]]
