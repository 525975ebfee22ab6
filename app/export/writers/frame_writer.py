"""Writers that turn the frames of an export into files."""

from typing import IO, Any

from app.export.plan import ExportPlan
from engine.arrays import Bytes


class FrameWriter:
    """Base of the writers of all frame formats; the file must be seekable.

    `encode` is called once for each frame, on several threads and out of order. All other methods
    are called on one thread, in the order of the frames. No method is called on the drawing thread.
    """

    def __init__(self, file: IO[bytes], plan: ExportPlan) -> None:
        self._file = file
        self._plan = plan

    def encode(self, frame: Bytes) -> Any:
        """Do the slow part of a frame, uint8 (h, w, 4) with straight alpha."""
        raise NotImplementedError

    def add(self, encoded: Any) -> None:
        """Write the next frame from the result of `encode`."""
        raise NotImplementedError

    def finish(self) -> None:
        """Write the data after the last frame."""

    def close(self) -> None:
        """Release resources that must not outlive the file, finished or not."""


def frame_duration(index: int, fps: float, *, per_second: int) -> int:
    """Return the duration of a frame in clock ticks, so that the sum never drifts."""
    return round((index + 1) * per_second / fps) - round(index * per_second / fps)
