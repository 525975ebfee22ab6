"""What turns the frames of an export into files."""

from typing import IO, Any

from app.export.plan import ExportPlan
from engine.arrays import Bytes


class FrameWriter:
    """One format's way to a file; the base of all of them.

    `encode` is called once for each frame, on several threads and out of order; all else on one
    thread, in the order of the frames. Nothing is called on the thread that draws.

    Parameters
    ----------
    file : binary file
        It can be written to anywhere.
    """

    def __init__(self, file: IO[bytes], plan: ExportPlan) -> None:
        self._file = file
        self._plan = plan

    def encode(self, frame: Bytes) -> Any:
        """Do the long part of the work for a frame, uint8 (h, w, 4) with straight alpha."""
        raise NotImplementedError

    def add(self, encoded: Any) -> None:
        """Put the next frame, as `encode` returned it, where it belongs."""
        raise NotImplementedError

    def finish(self) -> None:
        """Write what comes after the last frame."""

    def close(self) -> None:
        """Let go of what must not outlive the file, whether it is finished or not."""


def frame_duration(index: int, fps: float, *, per_second: int) -> int:
    """Return how many ticks of a clock a frame lasts, so that the sum never drifts."""
    return round((index + 1) * per_second / fps) - round(index * per_second / fps)
