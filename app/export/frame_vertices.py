"""The vertices of a layer in the frames of an export."""

from typing import Final, Protocol

import numpy as np
import numpy.typing as npt

from app.storage import Cancellation
from engine.arrays import Complexes

CACHE_BUDGET: Final = 2**28  # bytes of positions cached between framing and drawing


class FrameVertices(Protocol):
    """Posed mesh vertices of a layer at any time."""

    def positions(self, frame: float) -> Complexes:
        """Return the vertices, complex128 (v,), at a frame or between two frames."""


class CachedVertices:
    """Posed vertices with a cache: each pose is computed once within a memory budget.

    Framing, decimation and drawing request the same poses in turn. The cache keeps them in single
    precision, as they are drawn. Poses beyond the budget, in bytes, are computed again. A cancelled
    export computes no further poses.
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
        """Return the positions, and keep them in the cache."""
        self._cancellation.check()
        if frame in self._kept:
            return self._kept[frame].astype(np.complex128)
        positions = self._poses.positions(frame)
        if 8 * len(positions) <= self._room:
            self._room -= 8 * len(positions)
            self._kept[frame] = positions.astype(np.complex64)
        return positions

    def positions(self, frame: float) -> Complexes:
        """Return the positions, and remove them from the cache."""
        self._cancellation.check()
        kept = self._kept.pop(frame, None)
        return self._poses.positions(frame) if kept is None else kept.astype(np.complex128)
