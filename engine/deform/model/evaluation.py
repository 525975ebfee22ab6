"""A map evaluated at the samples and handles."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from engine.arrays import Complexes, Floats
from engine.deform.model.energy import symmetric_dirichlet
from engine.geometry import Similarity


@dataclass(frozen=True, kw_only=True, eq=False)
class Evaluation:
    """Derivatives of a map at the samples and handles; real-linear in its coefficients.

    Parameters
    ----------
    f, g : complex128, shape (m,)
        f_z and conj(f_z̄) at the samples.
    positions, fz : complex128, shape (h,)
        The map and f_z at the handles.
    shaft_positions : complex128, shape (t,)
        The map at the points of the armature.
    """

    f: Complexes
    g: Complexes
    positions: Complexes
    fz: Complexes
    shaft_positions: Complexes

    @cached_property
    def a(self) -> Floats:
        """|f_z| at the samples, float64 (m,)."""
        moduli: Floats = np.abs(self.f)
        return moduli

    @cached_property
    def b(self) -> Floats:
        """|f_z̄| at the samples, float64 (m,)."""
        moduli: Floats = np.abs(self.g)
        return moduli

    @cached_property
    def density(self) -> Floats:
        """The symmetric Dirichlet density at the samples, float64 (m,)."""
        # A trial step may overflow; there the energy is ∞.
        with np.errstate(over="ignore", invalid="ignore"):
            return symmetric_dirichlet(self.a, self.b)

    def scaled(self, factor: float) -> "Evaluation":
        """Return the evaluation of a change times a factor."""
        return Evaluation(
            f=factor * self.f,
            g=factor * self.g,
            positions=factor * self.positions,
            fz=factor * self.fz,
            shaft_positions=factor * self.shaft_positions,
        )

    def moved(self, motion: Similarity) -> "Evaluation":
        """Return the evaluation of a map followed by a rigid motion."""
        return Evaluation(
            f=motion.factor * self.f,
            g=np.conj(motion.factor) * self.g,
            positions=motion.apply(self.positions),
            fz=motion.factor * self.fz,
            shaft_positions=motion.apply(self.shaft_positions),
        )

    def advanced(self, length: float, direction: "Evaluation") -> "Evaluation":
        """Return the evaluation of the map `length` steps along a direction."""
        return Evaluation(
            f=self.f + length * direction.f,
            g=self.g + length * direction.g,
            positions=self.positions + length * direction.positions,
            fz=self.fz + length * direction.fz,
            shaft_positions=self.shaft_positions + length * direction.shaft_positions,
        )
