"""Animated WebP: the data of ordinary lossless WebP files, framed.

Source: https://developers.google.com/speed/webp/docs/riff_container
"""

import io
import struct
from collections.abc import Iterator
from typing import IO, Final

from PIL import Image

from app.export.plan import ExportPlan
from app.export.writers.frame_writer import FrameWriter, frame_duration
from engine.arrays import Bytes

_ANIMATED, _ALPHA = 0x02, 0x10
# Every frame replaces the previous frame, also its transparent parts.
_NO_BLENDING: Final = 0x02
_LONGEST: Final = 2**24 - 1  # largest duration of a frame, in milliseconds
# A third smaller than the fastest setting, in a quarter of the time of the default.
_METHOD, _EFFORT = 1, 20


class WebpWriter(FrameWriter):
    """Writes an animated WebP file frame by frame."""

    def __init__(self, file: IO[bytes], plan: ExportPlan) -> None:
        super().__init__(file, plan)
        self._size = plan.view.size
        self._count = 0
        file.write(b"RIFF\0\0\0\0WEBP")  # the length is written at the end
        extended = struct.pack("<B3x", _ANIMATED | _ALPHA)
        self._write(b"VP8X", extended + b"".join(_int24(side - 1) for side in self._size))
        transparent, plays = 0, 0 if plan.loop else 1  # 0 loops forever
        self._write(b"ANIM", struct.pack("<IH", transparent, plays))

    def encode(self, frame: Bytes) -> bytes:
        """Return a WebP file of the frame."""
        stream = io.BytesIO()
        Image.fromarray(frame).save(stream, "WEBP", lossless=True, quality=_EFFORT, method=_METHOD)
        return stream.getvalue()

    def add(self, encoded: bytes) -> None:
        """Copy the picture data of a WebP file into the animation."""
        lasts = min(frame_duration(self._count, self._plan.fps, per_second=1000), _LONGEST)
        self._count += 1
        numbers = (0, 0, *(side - 1 for side in self._size), lasts)
        pictures = b"".join(
            _chunk(kind, data)
            for kind, data in _chunks(encoded)
            if kind in {b"ALPH", b"VP8 ", b"VP8L"}
        )
        self._write(
            b"ANMF", b"".join(map(_int24, numbers)) + struct.pack("<B", _NO_BLENDING) + pictures
        )

    def finish(self) -> None:
        """Write the length of the file."""
        length = self._file.tell() - 8
        self._file.seek(4)
        self._file.write(struct.pack("<I", length))
        self._file.seek(0, io.SEEK_END)

    def _write(self, kind: bytes, data: bytes) -> None:
        self._file.write(_chunk(kind, data))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return kind + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)


def _chunks(webp: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield the kind and the data of each chunk of a WebP file."""
    start = 12
    while start < len(webp):
        (length,) = struct.unpack_from("<I", webp, start + 4)
        yield webp[start : start + 4], webp[start + 8 : start + 8 + length]
        start += 8 + length + length % 2


def _int24(value: int) -> bytes:
    return value.to_bytes(3, "little")
