"""Planar harmonic maps f = Φ + conj(Ψ) with Φ and Ψ in the span of the Cauchy coordinates."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, as_points
from engine.errors import EngineError
from engine.maps.cauchy import evaluate


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HarmonicMap:
    """A harmonic map in closed form, Equations (1) and (14).

    Parameters
    ----------
    cage : complex128, shape (n,)
        Vertices in counter-clockwise order.
    phi, psi : complex128, shape (n,)
        Coefficients of Φ and Ψ. (phi + c, psi − conj(c)) is the same map for every c: compare maps
        at points, never by their coefficients.

    Raises
    ------
    EngineError
        If the three arrays differ in length, or hold anything but finite numbers.
    """

    cage: Complexes
    phi: Complexes
    psi: Complexes

    def __post_init__(self) -> None:
        for name in ("cage", "phi", "psi"):
            object.__setattr__(self, name, as_points(getattr(self, name), name, at_least=3))
        if not len(self.cage) == len(self.phi) == len(self.psi):
            raise EngineError(
                f"A map over a cage of {len(self.cage)} vertices needs as many coefficients, not "
                f"{len(self.phi)} phi and {len(self.psi)} psi."
            )

    @classmethod
    def identity(cls, cage: Complexes) -> Self:
        """Return the map that leaves every point where it is."""
        return cls(cage=cage, phi=cage, psi=np.zeros_like(cage))

    def __call__(self, points: Complexes) -> Complexes:
        """Return f at points (m,) strictly inside the cage."""
        (values,) = evaluate(self.cage, self._coefficients(), points, orders=(0,))
        return values[:, 0] + values[:, 1].conj()

    def derivatives(self, points: Complexes) -> tuple[Complexes, Complexes]:
        """Return f_z and f_z̄, each (m,).

        Departs from the paper: its text lost the conjugation bars. f_z = Φ' is holomorphic, and
        f_z̄ = conj(Ψ') is anti-holomorphic.
        """
        (first,) = evaluate(self.cage, self._coefficients(), points, orders=(1,))
        return first[:, 0], first[:, 1].conj()

    def second_derivatives(self, points: Complexes) -> tuple[Complexes, Complexes]:
        """Return f_zz = Φ'' and f_z̄z̄ = conj(Ψ''), each (m,); the mixed one is 0 (harmonicity)."""
        (second,) = evaluate(self.cage, self._coefficients(), points, orders=(2,))
        return second[:, 0], second[:, 1].conj()

    def _coefficients(self) -> Complexes:
        return np.column_stack([self.phi, self.psi])
