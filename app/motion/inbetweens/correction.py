"""What tracks and springs add to a frame of the motion from key to key."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes
from engine.interpolation import Frame
from engine.maps import Span


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FrameCorrection:
    """A map of the figure's span.

    Parameters
    ----------
    phi, psi : complex128, shape (n,)
        Coefficients over the functions of the span.
    misses : mapping of int to float
        By how many pixels handles, by their ids, miss where their tracks want them.
    wishes : mapping of int to complex
        Where that is, of the same handles.
    limits : tuple of str
        What of it bounds hold back, in words, if one is reached; see `Extremes.reached`.
    steps : int
        Newton's, of all that was solved.
    """

    phi: Complexes
    psi: Complexes
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
        return self.phi.nbytes + self.psi.nbytes

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
        # In the coordinates' own precision: what is added is small beside the places.
        both = np.column_stack([self.phi, self.psi])
        shift = np.matmul(coordinates, both, dtype=coordinates.dtype, casting="same_kind")
        places: Complexes = positions + shift[:, 0] + shift[:, 1].conj()
        return places

    def of(self, frame: Frame, span: Span, points: Complexes) -> Frame:
        """Return a frame of the base motion corrected, at points (p,) of the figure at rest."""
        values, slopes = span.evaluate(np.column_stack([self.phi, self.psi]), points, orders=(0, 1))
        return Frame(
            positions=frame.positions + values[:, 0] + values[:, 1].conj(),
            fz=frame.fz + slopes[:, 0],
            fzbar=frame.fzbar + slopes[:, 1].conj(),
            rho=frame.rho,
        )
