"""Animated PNG: the data of ordinary PNG files, each with a frame control chunk before it.

Source: https://www.w3.org/TR/png-3/#apng-frame-based-animation
"""

import struct
from collections.abc import Iterator
from fractions import Fraction
from typing import IO, Final

from app.export.plan import ExportPlan
from app.export.writers.png import SIGNATURE, PngFrames, png_chunk

# A frame's duration is a fraction of two 16-bit numbers, in seconds. This leaves room for rounding.
_LARGEST: Final = 65_000
# Every frame replaces the previous frame, also its transparent parts.
_DISPOSE_NONE, _BLEND_SOURCE = 0, 0


class ApngWriter(PngFrames):
    """Writes an animated PNG file frame by frame."""

    def __init__(self, file: IO[bytes], plan: ExportPlan) -> None:
        super().__init__(file, plan)
        self._chunks = 0  # count of numbered chunks
        self._started = False

    def add(self, encoded: bytes) -> None:
        """Copy the picture data of a PNG file into the animation."""
        chunks = list(_chunks(encoded))
        is_first = not self._started
        if is_first:
            self._start([each for each in chunks if each[0] in {b"IHDR", b"sRGB"}])
        self._write(b"fcTL", self._frame_control())
        for kind, data in chunks:
            if kind == b"IDAT":
                # Readers without animation support show the ordinary data chunks.
                self._write(*((b"IDAT", data) if is_first else (b"fdAT", self._number() + data)))

    def finish(self) -> None:
        self._write(b"IEND", b"")

    def _start(self, chunks: list[tuple[bytes, bytes]]) -> None:
        self._started = True
        self._file.write(SIGNATURE)
        for each in chunks:
            self._write(*each)
        plays = 0 if self._plan.loop else 1  # 0 loops forever
        self._write(b"acTL", struct.pack(">II", len(self._plan.times), plays))

    def _frame_control(self) -> bytes:
        seconds = min(1 / Fraction(self._plan.fps), Fraction(_LARGEST))
        # 24 stays 1/24 of a second, 23.976 becomes 125/2997.
        seconds = seconds.limit_denominator(int(_LARGEST / max(Fraction(1), seconds)))
        place = (*self._plan.view.size, 0, 0)
        delay = (seconds.numerator, seconds.denominator)
        return self._number() + struct.pack(
            ">IIIIHHBB", *place, *delay, _DISPOSE_NONE, _BLEND_SOURCE
        )

    def _number(self) -> bytes:
        number = struct.pack(">I", self._chunks)
        self._chunks += 1
        return number

    def _write(self, kind: bytes, data: bytes) -> None:
        self._file.write(png_chunk(kind, data))


def _chunks(png: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield the kind and the data of each chunk of a PNG file."""
    start = len(SIGNATURE)
    while start < len(png):
        (length,) = struct.unpack_from(">I", png, start)
        yield png[start + 4 : start + 8], png[start + 8 : start + 8 + length]
        start += length + 12
