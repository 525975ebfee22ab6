"""Parts of PNG files that Pillow reads differently: transparent colours, damaged chunks."""

import io
import struct
import zlib
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageFile, PngImagePlugin

from app.texts import _
from engine.arrays import Booleans, Bytes

PNG: Final = b"\x89PNG\r\n\x1a\n"
DEPTH: Final = 24  # place of the bits per channel in the file
BYTE: Final = 8  # bits
# The bit of a chunk's name that says that the picture can be decoded without it.
ANCILLARY: Final = 0x20


def without_damaged_chunks(data: bytes) -> tuple[bytes, tuple[str, ...]]:
    """Return a PNG file without the ancillary chunks that have a wrong checksum, and a notice."""
    kept, names = [data[: len(PNG)]], []
    at = len(PNG)
    while at + 12 <= len(data):
        length, name = struct.unpack_from(">I4s", data, at)
        chunk, at = data[at : at + 12 + length], at + 12 + length
        if name[0] & ANCILLARY and chunk[-4:] != struct.pack(">I", zlib.crc32(chunk[4:-4])):
            names.append(name.decode("latin-1"))
        else:
            kept.append(chunk)
    if not names:
        return data, ()
    notice = _("damaged parts of the file were ignored ({names})").format(
        names=", ".join(dict.fromkeys(names))
    )
    return b"".join([*kept, data[at:]]), (notice,)


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
