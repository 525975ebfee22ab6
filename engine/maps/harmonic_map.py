"""Planar harmonic maps f = Φ + conj(Ψ) with Φ and Ψ in the span of the Cauchy coordinates."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, as_points, freeze
from engine.errors import EngineError
from engine.geometry import Hole
from engine.maps.span import Span

NO_MAPS = "There is no map to differentiate; give at least one."
COEFFICIENT_COUNT = (
    "A map over a cage of {count} vertices needs {count} coefficients, not {phi} phi and {psi} psi."
)


def _none() -> Complexes:
    return freeze(np.empty(0, dtype=np.complex128))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HarmonicMap:
    """A harmonic map in closed form, Equation (1), and around holes `engine.maps.span`.

    Parameters
    ----------
    cage : complex128, shape (n,)
        Vertices in counter-clockwise order.
    phi, psi : complex128, shape (N,)
        Coefficients of Φ and Ψ: those of the cage first, then those of the cage in each hole. (phi
        + c, psi − conj(c)), with c constant on the cage, is the same map for every c, and constants
        on the cage of a hole change no map. So compare maps at points, never by their coefficients.
    logs : complex128, shape (holes,)
        a_j: the map has the terms 2 a_j ln|z − c_j|.

    Raises
    ------
    EngineError
        If the numbers of coefficients, vertices and holes do not match, or a coefficient is not a
        finite number.
    """

    cage: Complexes
    phi: Complexes
    psi: Complexes
    holes: tuple[Hole, ...] = ()
    logs: Complexes = field(default_factory=_none)

    def __post_init__(self) -> None:
        for name in ("cage", "phi", "psi"):
            object.__setattr__(self, name, as_points(getattr(self, name), name, at_least=3))
        object.__setattr__(self, "logs", as_points(self.logs, "logs"))
        count = len(self.cage) + sum(len(hole.cage) for hole in self.holes)
        if not count == len(self.phi) == len(self.psi):
            raise EngineError(COEFFICIENT_COUNT, count=count, phi=len(self.phi), psi=len(self.psi))
        if len(self.logs) != len(self.holes):
            raise EngineError(
                "A map needs one logarithm for each of the {count} holes, not {given}.",
                count=len(self.holes),
                given=len(self.logs),
            )

    @classmethod
    def identity(cls, cage: Complexes, holes: tuple[Hole, ...] = ()) -> Self:
        return cls.similarity(cage, holes)

    @classmethod
    def similarity(
        cls, cage: Complexes, holes: tuple[Hole, ...], *, factor: complex = 1, shift: complex = 0
    ) -> Self:
        """Return the map z ↦ factor · z + shift."""
        cage = as_points(cage, "cage")
        inside = np.zeros(sum(len(hole.cage) for hole in holes), dtype=np.complex128)
        phi = np.concatenate([factor * cage + shift, inside])
        logs = np.zeros(len(holes), dtype=np.complex128)
        return cls(cage=cage, phi=phi, psi=np.zeros_like(phi), holes=holes, logs=logs)

    @property
    def span(self) -> Span:
        """The functions whose combinations are Φ and Ψ."""
        return Span(cage=self.cage, holes=self.holes)

    @property
    def coefficients(self) -> Complexes:
        """The coefficients of Φ and Ψ in the span, logarithms included, complex128 (n, 2)."""
        return np.column_stack(self.columns)

    @property
    def columns(self) -> tuple[Complexes, Complexes]:
        """The coefficients of Φ and of Ψ, logarithms included, complex128 (n,) each."""
        if not self.holes:
            return self.phi, self.psi
        logs = self.logs
        return np.concatenate([self.phi, logs]), np.concatenate([self.psi, logs.conj()])

    def changed(self, phi: Complexes, psi: Complexes) -> Self:
        """Return the map with changes added to its `columns`.

        `psi` ends in the conjugates of the last entries of `phi`.
        """
        count = len(self.phi)
        logs = self.logs + phi[count:]
        return replace(self, phi=self.phi + phi[:count], psi=self.psi + psi[:count], logs=logs)

    def is_same(self, other: "HarmonicMap") -> bool:
        return all(map(np.array_equal, self.columns, other.columns))

    def __call__(self, points: npt.ArrayLike) -> Complexes:
        """Return f at points (m,); NaN outside the cage, and inside the cages of holes."""
        z = as_points(points, "points")
        (values,) = self.span.evaluate(self.coefficients, z, orders=(0,))
        return values[:, 0] + values[:, 1].conj()  # Equation (1)

    def derivatives(self, points: npt.ArrayLike) -> tuple[Complexes, Complexes]:
        """Return f_z and f_z̄, each (m,); NaN where the map has no value.

        Departs from the paper: its text lost the conjugation bars. f_z = Φ' is holomorphic, and
        f_z̄ = conj(Ψ') is anti-holomorphic.
        """
        z = as_points(points, "points")
        (first,) = self.span.evaluate(self.coefficients, z, orders=(1,))
        return first[:, 0], first[:, 1].conj()

    def moved(self, factor: complex, shift: complex) -> Self:
        """Return factor · f + shift; a factor of modulus 1 keeps the distortion."""
        factor = complex(factor)
        phi = factor * self.phi
        # The coordinates of the outer cage sum to 1: a constant is the same at all its vertices.
        phi[: len(self.cage)] += shift
        return replace(self, phi=phi, psi=factor.conjugate() * self.psi, logs=factor * self.logs)


def derivatives_of(maps: Sequence[HarmonicMap], points: Complexes) -> tuple[Complexes, Complexes]:
    """Return f_z and f_z̄ of maps in one span at points (m,), each (q, m).

    The logarithms of the points serve all maps.
    """
    if not maps:
        raise EngineError(NO_MAPS)
    points = as_points(points, "points")
    coefficients = np.hstack([f.coefficients for f in maps])
    (first,) = maps[0].span.evaluate(coefficients, points, orders=(1,))
    return first[:, ::2].T, first[:, 1::2].T.conj()
