"""Where the vertices of a layer are in the frames of an export."""

from typing import Final, Protocol

import numpy as np
import numpy.typing as npt

from app.storage import Cancellation
from engine.arrays import Complexes

CACHE_BUDGET: Final = 2**28  # bytes of positions that are kept from the framing for the drawing


class FrameVertices(Protocol):
    """Where the vertices of a layer's mesh are at any time."""

    def positions(self, frame: float) -> Complexes:
        """Return the vertices, complex128 (v,), at a frame, whole or between two."""


class CachedVertices:
    """Poses each of which is worked out once though it is asked for several times, in a budget.

    First for the framing, then to choose triangles, and last for the drawing. What is kept in
    between has the single precision that is drawn.

    Parameters
    ----------
    cancellation : Cancellation, optional
        Of the export: once it was cancelled, no more of them are worked out.
    budget : int
        In bytes; what does not fit is worked out again.
    """

    def __init__(
        self,
        poses: FrameVertices,
        cancellation: Cancellation | None = None,
        *,
        budget: int = CACHE_BUDGET,
    ) -> None:
        self._poses = poses
        self._cancellation = cancellation or Cancellation()
        self._room = budget
        self._kept: dict[float, npt.NDArray[np.complex64]] = {}

    def cache_positions(self, frame: float) -> Complexes:
        """Return the positions, and keep them for when they are asked for again."""
        self._cancellation.check()
        if frame in self._kept:
            return self._kept[frame].astype(np.complex128)
        positions = self._poses.positions(frame)
        if 8 * len(positions) <= self._room:
            self._room -= 8 * len(positions)
            self._kept[frame] = positions.astype(np.complex64)
        return positions

    def positions(self, frame: float) -> Complexes:
        """Return the positions, and keep them no longer."""
        self._cancellation.check()
        kept = self._kept.pop(frame, None)
        return self._poses.positions(frame) if kept is None else kept.astype(np.complex128)
