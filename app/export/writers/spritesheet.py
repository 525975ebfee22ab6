"""All frames side by side in one PNG, row by row."""

import io
import math
import threading
from typing import IO, Any, Final, cast

import numpy as np

from app.errors import LissomError
from app.export.plan import ExportPlan
from app.export.writers.frame_writer import FrameWriter
from app.export.writers.png import save_png
from engine.arrays import Bytes

LARGEST: Final = 16_384  # pixels each way: what graphics cards hold, and a gigabyte at most


class SpritesheetWriter(FrameWriter):
    """Collects the frames and writes the sheet in the end.

    Parameters
    ----------
    file : binary file
    plan : ExportPlan

    Raises
    ------
    LissomError
        If the sheet would be too large.
    """

    def __init__(self, file: IO[bytes], plan: ExportPlan) -> None:
        self._file = file
        self._stopped = threading.Event()
        self._width, self._height = plan.view.size
        self._columns, rows = sheet_grid(plan)
        self._sheet = np.zeros((rows * self._height, self._columns * self._width, 4), np.uint8)

    def encode(self, index: int, frame: Bytes) -> bytes:
        """Put the frame in its place."""
        row, column = divmod(index, self._columns)
        top, left = row * self._height, column * self._width
        self._sheet[top : top + self._height, left : left + self._width] = frame
        return b""

    def finish(self) -> None:
        """Write the sheet."""
        save_png(self._sheet, cast(IO[bytes], _Stoppable(self._file, self._stopped)))

    def stop(self) -> None:
        """End the writing of the sheet, which may take seconds."""
        self._stopped.set()


class _Stoppable(io.BufferedIOBase):
    """A file for writing that refuses to go on once it was stopped."""

    def __init__(self, file: IO[bytes], stopped: threading.Event) -> None:
        self._file = file
        self._stopped = stopped

    def write(self, buffer: Any) -> int:
        if self._stopped.is_set():
            raise LissomError("the export was stopped")
        return self._file.write(buffer)


def sheet_grid(plan: ExportPlan) -> tuple[int, int]:
    """Return the columns and rows of a sheet that is nearly a square.

    Raises
    ------
    LissomError
        If it would be too large.
    """
    (width, height), count = plan.view.size, len(plan.times)
    most = min(LARGEST // width, count)
    columns = max(1, min(most, math.ceil(math.sqrt(count * height / width))))
    rows = math.ceil(count / columns)
    if max(columns * width, rows * height) > LARGEST:
        raise LissomError(
            f"{count} frames of {width} × {height} pixels do not fit on a sheet of {LARGEST:,} × "
            f"{LARGEST:,}; choose fewer frames or a smaller size"
        )
    return math.ceil(count / rows), rows  # without columns that stay empty
