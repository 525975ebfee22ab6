"""The largest picture of an icon file (ICO), as a PNG file."""

import io
import struct
from typing import Final

from PIL import Image
from PIL.IcoImagePlugin import IcoFile

from app.storage.pictures.png import PNG

ICO: Final = b"\0\0\1\0"
BITS: Final = 14  # place of the bits per pixel in a bitmap's header
WITH_ALPHA: Final = 32  # bits per pixel


def largest_icon(data: bytes) -> bytes:
    """Return the largest picture of an icon file; of equal sizes the one with most colours."""
    icon = IcoFile(io.BytesIO(data))
    index, entry = max(
        enumerate(icon.entry), key=lambda found: (found[1].square, found[1].color_depth)
    )
    stored = data[entry.offset : entry.offset + entry.size]
    if stored.startswith(PNG):
        return stored
    (bits,) = struct.unpack_from("<H", stored, BITS)
    # The directory may leave the bits out.
    icon.entry[index] = entry._replace(bpp=bits)
    image = icon.frame(index)
    if bits == WITH_ALPHA and image.getchannel("A").getbbox() is None:
        image.putalpha(_mask(stored, image.size))
    file = io.BytesIO()
    image.save(file, "PNG", compress_level=1)
    return file.getvalue()


def _mask(stored: bytes, size: tuple[int, int]) -> Image.Image:
    """Return the opacity of a bitmap without alpha from its mask; opaque without a mask."""
    row = (size[0] + 31) // 32 * 4
    (header,) = struct.unpack_from("<I", stored)
    mask = stored[header + size[0] * size[1] * WITH_ALPHA // 8 :]
    if len(mask) < row * size[1]:
        return Image.new("L", size, 255)
    return Image.frombytes("1", size, mask, "raw", "1;I", row, -1).convert("L")
