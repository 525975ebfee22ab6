"""The η variants (Sections 5.1, 5.4 and 5.5)."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.interpolation.derivatives import Derivatives, Passage, weighted
from engine.interpolation.periods import combined


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EtaBlend:
    """log f_z and η linear in the weights, Equations (3) and (6): Properties 1, 2 and 8.

    Scaled by ρ (`engine.interpolation.scaling`) it has Properties 3 to 7 as well.

    Parameters
    ----------
    passage : Passage
        Another branch of its logarithms only turns the in-betweens.
    conj_eta, conj_eta_z : tuple of complex128, shape (s,)
        conj(η) = Φ' Ψ' of each keyframe, holomorphic, and its derivative.
    """

    passage: Passage
    conj_eta: tuple[Complexes, ...]
    conj_eta_z: tuple[Complexes, ...]

    @classmethod
    def of(cls, passage: Passage) -> Self:
        """Work out η of the keyframes."""
        values, derivatives = [], []
        for key in passage.keyframes:
            squared = np.exp(2 * key.log_fz)
            values.append(freeze(key.nu * squared))
            derivatives.append(freeze((key.nu_z + 2 * key.nu * key.log_fz_z) * squared))
        return cls(passage=passage, conj_eta=tuple(values), conj_eta_z=tuple(derivatives))

    @property
    def nbytes(self) -> int:
        """Memory beyond the passage's own, in bytes."""
        return sum(array.nbytes for array in (*self.conj_eta, *self.conj_eta_z))

    def values(self, times: Floats) -> tuple[Complexes, Complexes]:
        """Return f_z and conj(f_z̄) at times (t,), each (t, s)."""
        course = self.passage.eta_course or self.passage.course
        fz = np.exp(self.passage.log_fz_at(times))
        g = combined(course.at(times).T, np.array(self.conj_eta))
        g /= fz
        return fz, g

    def derivatives(self, time: float) -> Derivatives:
        """Blend f_z logarithmically and η linearly.

        Departs from the paper: Equation (7) lost a bar; it reads f_z̄ = η / conj(f_z), that is
        Ψ' = conj(η) / Φ'. The unscaled Ψ' is returned; ρ is a factor of it.
        """
        weights = (self.passage.eta_course or self.passage.course)(time)
        logarithm, logarithm_z = self.passage.log_fz(time)
        fz = np.exp(logarithm)
        inverse = 1.0 / fz
        g = weighted(self.conj_eta, weights)
        gz = weighted(self.conj_eta_z, weights)
        gz -= g * logarithm_z
        gz *= inverse
        g *= inverse
        return Derivatives(fz=fz, fzz=logarithm_z * fz, g=g, gz=gz)

    def at(self, which: Indices) -> Self:
        """Return the same at some of the nodes only."""
        return type(self)(
            passage=self.passage.at(which),
            conj_eta=tuple(freeze(values[which]) for values in self.conj_eta),
            conj_eta_z=tuple(freeze(values[which]) for values in self.conj_eta_z),
        )
