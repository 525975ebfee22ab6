"""Decoded pictures, reduced and packed, so that hundreds of them fit in memory."""

import io
from dataclasses import dataclass
from typing import Final

import numpy as np
from PIL import Image
from zlib_ng import zlib_ng

from engine.arrays import Bytes, freeze

# Bytes of a picture that is packed without loss; a larger one, such as a frame of a film, is packed
# with a loss that nobody sees.
_LARGEST_LOSSLESS: Final = 400_000
_QUALITY: Final = 90
_LEVEL: Final = 1
OPAQUE: Final = 255


@dataclass(frozen=True, slots=True, eq=False)
class PackedPicture:
    """A picture of footage for the window."""

    reduction: int  # pixels of the footage per stored pixel, each way
    size: tuple[int, int]  # width and height of the stored picture
    data: bytes
    is_lossless: bool

    @property
    def nbytes(self) -> int:
        return len(self.data)

    def unpack(self) -> Bytes:
        """Return the pixels, uint8 (h, w, 4)."""
        width, height = self.size
        if self.is_lossless:
            pixels = np.frombuffer(zlib_ng.decompress(self.data), np.uint8)
            return freeze(pixels.reshape(height, width, 4))
        with Image.open(io.BytesIO(self.data), formats=("JPEG", "WEBP")) as image:
            return freeze(np.asarray(image.convert("RGBA")))


def pack_picture(pixels: Bytes, reduction: int) -> PackedPicture:
    """Reduce a picture, uint8 (h, w, 4), by a whole factor each way, and pack it."""
    image = Image.fromarray(pixels)
    if reduction > 1:
        # Premultiplied, so that clear pixels do not colour the edges.
        image = image.convert("RGBa").reduce(reduction).convert("RGBA")
    packed = zlib_ng.compress(image.tobytes(), _LEVEL)
    is_lossless = len(packed) <= _LARGEST_LOSSLESS
    if not is_lossless:
        file = io.BytesIO()
        if np.asarray(image)[..., 3].min() == OPAQUE:
            image.convert("RGB").save(file, "JPEG", quality=_QUALITY)
        else:
            image.save(file, "WEBP", quality=_QUALITY, method=0, exact=False)
        packed = file.getvalue()
    return PackedPicture(reduction, image.size, packed, is_lossless)
