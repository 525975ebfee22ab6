"""Pixels that lie in a file without a name, of which memory holds only what was read just now.

A drawing on many large layers would be in memory twice: decoded, and on the graphics card.
"""

import mmap
import tempfile
from contextlib import suppress
from dataclasses import replace
from typing import Final

import numpy as np

from app.storage.pictures.picture import Picture
from engine.arrays import Bytes

# Where the system has no such thing, it takes the memory back by itself when it is short of it.
_UNREAD: Final = getattr(mmap, "MADV_DONTNEED", None)


def move_to_disk(picture: Picture) -> Picture:
    """Return a picture with its pixels in a file, which goes away with it; as it is if none fits.

    The file is written before it is mapped: on a full disk that fails, and no page of it later.
    """
    pixels = picture.rgba
    with suppress(OSError), tempfile.TemporaryFile() as file:
        file.write(np.ascontiguousarray(pixels).data)
        file.flush()
        mapped = mmap.mmap(file.fileno(), pixels.nbytes, access=mmap.ACCESS_READ)
        return replace(picture, rgba=np.frombuffer(mapped, np.uint8).reshape(pixels.shape))
    return picture


def release_pages(pixels: Bytes) -> None:
    """Let memory go that pixels in a file take; they are read anew when they are needed."""
    base: object = pixels
    while isinstance(base, np.ndarray):
        base = base.base
    if isinstance(base, memoryview):
        base = base.obj
    if isinstance(base, mmap.mmap) and _UNREAD is not None:
        base.madvise(_UNREAD)
