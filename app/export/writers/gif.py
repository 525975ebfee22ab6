"""Animated GIF: the data of ordinary GIF files, each with its own palette.

Source: https://www.w3.org/Graphics/GIF/spec-gif89a.txt
"""

import io
import struct
from typing import IO, Final

import numpy as np
from PIL import Image

from app.export.plan import ExportPlan
from app.export.writers.frame_writer import FrameWriter, frame_duration
from engine.arrays import Bytes

OPAQUE_FROM: Final = 128  # levels of alpha; half of a pixel on a soft edge
_LONGEST: Final = 65_535  # largest duration of a frame, in hundredths of a second
_CLEAR: Final = 255  # palette index of the transparent pixels
_DESCRIPTOR, _EXTENSION = 0x2C, 0x21
_CLEARED_AFTERWARDS, _HAS_CLEAR = 2 << 2, 1
_PALETTE_OF_256: Final = 0x80 | 7


class GifWriter(FrameWriter):
    """Writes an animated GIF file frame by frame.

    GIF has no soft edges. A pixel is opaque, in its own colour, from alpha `OPAQUE_FROM` on, and
    transparent below. Each frame has its own best 255 colours. Dithering is off, because its grain
    would crawl.
    """

    def __init__(self, file: IO[bytes], plan: ExportPlan) -> None:
        super().__init__(file, plan)
        self._count = 0
        self._file.write(b"GIF89a" + struct.pack("<HHBBB", *plan.view.size, 0, 0, 0))
        if plan.loop:
            for_ever = 0
            self._file.write(
                struct.pack("<BBB11sBBHB", _EXTENSION, 0xFF, 11, b"NETSCAPE2.0", 3, 1, for_ever, 0)
            )

    def encode(self, frame: Bytes) -> bytes:
        """Return the palette and the compressed pixels of the frame in GIF's encoding."""
        stream = io.BytesIO()
        _indexed(frame).save(stream, "GIF", optimize=False, interlace=False)
        return _palette_and_pixels(stream.getvalue())

    def add(self, encoded: bytes) -> None:
        """Write a frame with its duration and offset."""
        lasts = min(frame_duration(self._count, self._plan.fps, per_second=100), _LONGEST)
        self._count += 1
        flags = _CLEARED_AFTERWARDS | _HAS_CLEAR
        self._file.write(struct.pack("<BBBBHBB", _EXTENSION, 0xF9, 4, flags, lasts, _CLEAR, 0))
        place = (0, 0, *self._plan.view.size)
        self._file.write(struct.pack("<BHHHHB", _DESCRIPTOR, *place, _PALETTE_OF_256))
        self._file.write(encoded)

    def finish(self) -> None:
        self._file.write(b"\x3b")


def _indexed(frame: Bytes) -> Image.Image:
    """Return the frame in 255 colours and a transparent one."""
    opaque = frame[..., 3] >= OPAQUE_FROM
    colours = frame[..., :3][opaque]
    if not len(colours):
        colours = np.zeros((1, 3), dtype=np.uint8)
    # Exclude transparent pixels: their colours must not use up the palette.
    strip = Image.fromarray(colours[None]).quantize(_CLEAR, Image.Quantize.MEDIANCUT)
    palette = (strip.getpalette() or [])[: 3 * _CLEAR]
    indices = np.full(opaque.shape, _CLEAR, dtype=np.uint8)
    indices[opaque] = np.asarray(strip)[0]
    indexed = Image.fromarray(indices, "P")
    indexed.putpalette(palette + [0] * (3 * 256 - len(palette)))
    return indexed


def _palette_and_pixels(gif: bytes) -> bytes:
    """Return the palette of 256 colours and the pixel data of a GIF file with one picture."""
    palette = gif[13 : 13 + 3 * 256]
    start = 13 + 3 * 256
    while gif[start] == _EXTENSION:
        start = _after_blocks(gif, start + 2)
    pixels = start + 10
    return palette + gif[pixels : _after_blocks(gif, pixels + 1)]


def _after_blocks(gif: bytes, start: int) -> int:
    """Return the end of the run of blocks that begins at `start`; each begins with its length."""
    while gif[start]:
        start += 1 + gif[start]
    return start + 1
