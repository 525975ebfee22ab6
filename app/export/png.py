"""PNG pictures, and a sequence of them in a folder."""

import io
from typing import Final

from PIL import Image

from app.export.plan import ExportPlan
from app.storage import write_atomically
from engine.arrays import Bytes

# Higher levels take much longer for little: the drawing is small beside its empty surroundings.
COMPRESSION: Final = 3


def encode_png(frame: Bytes) -> bytes:
    """Return the bytes of a PNG file with a frame, uint8 (h, w, 4)."""
    stream = io.BytesIO()
    Image.fromarray(frame).save(stream, "PNG", compress_level=COMPRESSION)
    return stream.getvalue()


class PngSequence:
    """Writes each frame to a file of its own, as soon as it is drawn.

    Parameters
    ----------
    plan : ExportPlan
        Its folder exists.
    """

    def __init__(self, plan: ExportPlan) -> None:
        self._plan = plan

    def encode(self, index: int, frame: Bytes) -> bytes:
        """Write a frame's file."""
        data = encode_png(frame)
        path = self._plan.out / self._plan.frame_name(index)
        write_atomically(path, lambda file: file.write(data))
        return b""

    def add(self, encoded: bytes) -> None:
        """Do nothing: the file is there already."""

    def finish(self) -> None:
        """Do nothing: nothing comes after the last file."""
