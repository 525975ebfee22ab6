"""PNG pictures, and a sequence of them in a folder.

Source: https://www.w3.org/TR/png-3/
"""

import io
import struct
from typing import IO, Final

import numpy as np
from zlib_ng import zlib_ng

from app.export.plan import ExportPlan
from app.export.writers.frame_writer import FrameWriter
from app.storage import Cancellation, write_atomically
from engine.arrays import Bytes

SIGNATURE: Final = b"\x89PNG\r\n\x1a\n"
# Only runs of one byte. Row differences hold few other repeats; the search for them takes longer
# and makes drawings larger by a tenth and more.
_STRATEGY: Final = zlib_ng.Z_RLE
_LEVEL: Final = 1  # every level finds runs, this one is the fastest
_DEPTH, _RGBA = 8, 6
# Each row as its difference from the row above. Choosing among five filters for each row takes
# longer than all else, and makes drawings no smaller.
_UP = 2
_PIECE: Final = 2**20  # bytes compressed at a time
# Perceptual intent, the usual one. Without this chunk, colour-managed programs do not convert the
# picture to the screen's profile.
_PERCEPTUAL: Final = b"\0"


def save_png(frame: Bytes, file: IO[bytes]) -> None:
    """Write a frame, uint8 (h, w, 4), as a PNG file in sRGB."""
    height, width, _ = frame.shape
    file.write(SIGNATURE)
    file.write(png_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, _DEPTH, _RGBA, 0, 0, 0)))
    file.write(png_chunk(b"sRGB", _PERCEPTUAL))
    packer = zlib_ng.compressobj(_LEVEL, strategy=_STRATEGY)
    rows = frame.reshape(height, 4 * width)
    above = np.zeros(4 * width, dtype=np.uint8)
    filtered = np.empty((max(1, _PIECE // (4 * width)), 1 + 4 * width), dtype=np.uint8)
    filtered[:, 0] = _UP
    for top in range(0, height, len(filtered)):
        piece = rows[top : top + len(filtered)]
        np.subtract(piece[0], above, out=filtered[0, 1:])
        np.subtract(piece[1:], piece[:-1], out=filtered[1 : len(piece), 1:])
        above = piece[-1]
        if packed := packer.compress(filtered[: len(piece)].data):
            file.write(png_chunk(b"IDAT", packed))
    file.write(png_chunk(b"IDAT", packer.flush()))
    file.write(png_chunk(b"IEND", b""))


def png_chunk(kind: bytes, data: bytes) -> bytes:
    check = zlib_ng.crc32(data, zlib_ng.crc32(kind))
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", check)


def encode_png(frame: Bytes) -> bytes:
    """Return a PNG file of a frame, uint8 (h, w, 4)."""
    stream = io.BytesIO()
    save_png(frame, stream)
    return stream.getvalue()


class PngFrames(FrameWriter):
    """Base of the writers whose frames are PNG files."""

    def encode(self, frame: Bytes) -> bytes:
        return encode_png(frame)


class PngSequence(PngFrames):
    """Writes each frame to a file of its own, as soon as it is drawn; the folder must exist."""

    def __init__(self, plan: ExportPlan, cancellation: Cancellation) -> None:
        self._paths = iter([plan.out / name for name in plan.names])
        self._cancellation = cancellation

    def add(self, encoded: bytes) -> None:
        write_atomically(next(self._paths), lambda file: file.write(encoded), self._cancellation)


class PngPicture(PngFrames):
    """Writes a single frame to a file."""

    def add(self, encoded: bytes) -> None:
        self._file.write(encoded)
