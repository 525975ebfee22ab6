"""What Pillow reads differently: icons, and transparent colours and damaged chunks of PNG files."""

import io
import struct
import zlib
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageFile, PngImagePlugin
from PIL.IcoImagePlugin import IcoFile

from app.texts import _
from engine.arrays import Booleans, Bytes

ICO: Final = b"\0\0\1\0"
BITS: Final = 14  # place of the bits per pixel in the header of an icon's bitmap
WITH_ALPHA: Final = 32  # bits per pixel
PNG: Final = b"\x89PNG\r\n\x1a\n"
DEPTH: Final = 24  # place of the bits per channel in the file
BYTE: Final = 8  # bits
EMPTY_CHUNK: Final = 12  # bytes of the length, name and checksum of a chunk
LAST_CHUNK: Final = b"IEND"
# The bit of a chunk's name that says that the picture can be decoded without it.
ANCILLARY: Final = 0x20


def without_damaged_chunks(data: bytes) -> tuple[bytes, tuple[str, ...]]:
    """Return a PNG file without the ancillary chunks that have a wrong checksum, and a notice."""
    kept, names, at, begin, name = [], [], len(PNG), 0, b""
    while name != LAST_CHUNK and at + EMPTY_CHUNK <= len(data):
        length, name = struct.unpack_from(">I4s", data, at)
        end = at + EMPTY_CHUNK + length
        # Critical chunks, which are large, are checked when they are decoded.
        if name[0] & ANCILLARY and zlib.crc32(data[at + 4 : end - 4]) != _checksum(data, end):
            names.append(name.decode("latin-1"))
            kept.append(data[begin:at])
            begin = end
        at = end
    if not names:
        return data, ()
    notice = _("damaged parts of the file were ignored ({names})").format(
        names=", ".join(dict.fromkeys(names))
    )
    return b"".join([*kept, data[begin:]]), (notice,)


def _checksum(data: bytes, end: int) -> int:
    """Return the checksum of the chunk that ends here."""
    return int.from_bytes(data[end - 4 : end], "big")


def with_clear_colour(file: ImageFile.ImageFile, data: bytes) -> Image.Image:
    """Return a decoded PNG picture whose transparent colour is clear.

    Colours are compared at the depth of the file; Pillow compares those that it reduced to 8 bits.
    Palettes and black and white need no more than Pillow does.
    """
    colour = file.info.get("transparency")
    if colour is None or file.format != "PNG" or file.mode not in {"L", "I;16", "RGB"}:
        return file
    depth = data[DEPTH]
    most = (1 << depth) - 1
    # Only the lowest bits of the colour count.
    clear = np.array(colour) & most
    if depth < BYTE:
        clear = clear * 255 // most
    samples: npt.NDArray[Any] = np.asarray(file)
    picture = file.copy()
    if file.mode == "I;16":
        picture = Image.fromarray(np.rint(samples / 257).astype(np.uint8))
        picture.info = file.info.copy()
    elif depth > BYTE:
        samples = samples.astype(np.uint16) << BYTE | _lower_bytes(data)
    differs = samples != clear
    seen: Booleans = differs if differs.ndim == 2 else differs.any(axis=2)
    picture.putalpha(Image.fromarray(seen).convert("L"))
    del picture.info["transparency"]
    return picture


def _lower_bytes(data: bytes) -> Bytes:
    """Return the lower 8 bits of 16-bit colours (h, w, 3), which Pillow drops."""
    file = PngImagePlugin.PngImageFile(io.BytesIO(data))
    # As if the lower byte came last.
    file.tile = [tile._replace(args="RGB;16L") for tile in file.tile]
    return np.asarray(file)


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
