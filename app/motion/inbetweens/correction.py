"""What is added to a frame of the closed-form motion."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes
from engine.geometry import HERE, RigidMotion
from engine.interpolation import Frame
from engine.maps import Span


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FrameCorrection:
    """A rigid motion after the base motion, and a map of the figure's span.

    Parameters
    ----------
    motion : RigidMotion
    phi, psi : complex64 or complex128, shape (n,), or None
        Coefficients over the functions of the span; None where there are none.
    misses : mapping of int to float
        By how many pixels handles, by their ids, miss where their tracks want them.
    wishes : mapping of int to complex
        Where that is, of the same handles.
    limits : tuple of str
        What of it bounds hold back, in words, if one is reached; see `Extremes.reached`.
    steps : int
        Newton's, of all that was solved.
    """

    motion: RigidMotion = HERE
    phi: Complexes | None = None
    psi: Complexes | None = None
    misses: Mapping[int, float] = field(default_factory=dict)
    wishes: Mapping[int, complex] = field(default_factory=dict)
    limits: tuple[str, ...] = ()
    steps: int = 0

    @property
    def is_held_back(self) -> bool:
        """Whether a bound is reached."""
        return bool(self.limits)

    @property
    def nbytes(self) -> int:
        """Memory of the coefficients."""
        return 0 if self.phi is None or self.psi is None else self.phi.nbytes + self.psi.nbytes

    def beyond(self, other: "FrameCorrection | None") -> "FrameCorrection | None":
        """Return what it adds to a part of it that comes before; None where that is nothing."""
        if self is other or self.phi is None or self.psi is None:
            return None
        if other is None or other.phi is None or other.psi is None:
            return replace(self, motion=HERE)
        return replace(self, motion=HERE, phi=self.phi - other.phi, psi=self.psi - other.psi)

    def after(self, other: "FrameCorrection | None") -> "FrameCorrection":
        """Return what adds another correction first; this one moves nothing rigidly."""
        if other is None or other.phi is None or other.psi is None:
            return self if other is None else replace(self, motion=other.motion)
        phi = other.phi if self.phi is None else self.phi + other.phi
        psi = other.psi if self.psi is None else self.psi + other.psi
        return replace(self, motion=other.motion, phi=phi, psi=psi)

    def on(
        self, positions: Complexes, coordinates: Complexes | npt.NDArray[np.complex64]
    ) -> Complexes:
        """Return where points come to that the base motion has at positions (p,).

        Parameters
        ----------
        positions : complex128, shape (p,)
        coordinates : complex64 or complex128, shape (p, n)
            Of the functions of the span, at the points at rest.
        """
        moved = self.motion.on(positions)
        if self.phi is None or self.psi is None:
            return moved
        # In the coordinates' own precision: what is added is small beside the places.
        both = np.column_stack([self.phi, self.psi])
        shift = np.matmul(coordinates, both, dtype=coordinates.dtype, casting="same_kind")
        places: Complexes = moved + shift[:, 0] + shift[:, 1].conj()
        return places

    def of(self, frame: Frame, span: Span, points: Complexes) -> Frame:
        """Return a frame of the base motion corrected, at points (p,) of the figure at rest."""
        factor = self.motion.factor
        positions = self.motion.on(frame.positions)
        fz, fzbar = factor * frame.fz, factor * frame.fzbar
        if self.phi is None or self.psi is None:
            return Frame(positions=positions, fz=fz, fzbar=fzbar, rho=frame.rho)
        values, slopes = span.evaluate(np.column_stack([self.phi, self.psi]), points, orders=(0, 1))
        return Frame(
            positions=positions + values[:, 0] + values[:, 1].conj(),
            fz=fz + slopes[:, 0],
            fzbar=fzbar + slopes[:, 1].conj(),
            rho=frame.rho,
        )
