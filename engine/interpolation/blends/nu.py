"""The ν variant (Sections 5.1 and 5.2)."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.interpolation.derivatives import Derivatives, Passage, weighted
from engine.interpolation.periods import combined


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class NuBlend:
    """log f_z and ν linear in the weights, Equations (3) and (4): Properties 1 to 5 and 7.

    Parameters
    ----------
    passage : Passage
        A change of one of its sheets by a full turn changes the shape of the in-betweens, not only
        how it turns.
    """

    passage: Passage

    @property
    def nbytes(self) -> int:
        """Memory beyond the passage's own, in bytes."""
        return 0

    def values(self, times: Floats) -> tuple[Complexes, Complexes]:
        """Return f_z and conj(f_z̄) at times (t,), each (t, s)."""
        nu = np.array([key.nu for key in self.passage.keyframes])
        fz = np.exp(self.passage.log_fz_at(times))
        g = combined(self.passage.course.at(times).T, nu)
        g *= fz
        return fz, g

    def derivatives(self, time: float) -> Derivatives:
        """Blend f_z logarithmically and ν linearly.

        Departs from the paper: Equation (5) lost its second bar; it reads
        f_z̄ = conj(ν) conj(f_z), that is Ψ' = ν Φ'.
        """
        keyframes, weights = self.passage.keyframes, self.passage.course(time)
        logarithm, logarithm_z = self.passage.log_fz(time)
        fz = np.exp(logarithm)
        nu = weighted([key.nu for key in keyframes], weights)
        nu_z = weighted([key.nu_z for key in keyframes], weights)
        nu_z += nu * logarithm_z
        nu_z *= fz
        logarithm_z *= fz
        nu *= fz
        return Derivatives(fz=fz, fzz=logarithm_z, g=nu, gz=nu_z)

    def at(self, which: Indices) -> Self:
        """Return the same at some of the nodes only."""
        return type(self)(passage=self.passage.at(which))
