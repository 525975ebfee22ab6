"""PNG pictures, and a sequence of them in a folder."""

import io
from typing import IO, Final

from PIL import Image, PngImagePlugin

from app.export.plan import ExportPlan
from app.export.writers.frame_writer import FrameWriter
from app.storage import write_atomically
from engine.arrays import Bytes

# Higher levels take much longer for little: the drawing is small beside its empty surroundings.
COMPRESSION: Final = 3


# Perceptual intent, the usual one. Programs that manage colours leave a file that does not say what
# its numbers mean as it is, whatever the screen.
_SRGB: Final = (b"sRGB", b"\0")


def save_png(frame: Bytes, file: IO[bytes]) -> None:
    """Write a frame, uint8 (h, w, 4), as a PNG file in the colours of sRGB."""
    tags = PngImagePlugin.PngInfo()
    tags.add(*_SRGB)
    Image.fromarray(frame).save(file, "PNG", compress_level=COMPRESSION, pnginfo=tags)


def encode_png(frame: Bytes) -> bytes:
    """Return the bytes of a PNG file with a frame, uint8 (h, w, 4)."""
    stream = io.BytesIO()
    save_png(frame, stream)
    return stream.getvalue()


class PngSequence(FrameWriter):
    """Writes each frame to a file of its own, as soon as it is drawn.

    Parameters
    ----------
    plan : ExportPlan
        Its folder exists.
    """

    def __init__(self, plan: ExportPlan) -> None:
        self._folder = plan.out
        self._names = plan.names

    def encode(self, index: int, frame: Bytes) -> bytes:
        """Write a frame's file."""
        data = encode_png(frame)
        path = self._folder / self._names[index]
        write_atomically(path, lambda file: file.write(data))
        return b""
