"""Pixels in an unnamed file; memory holds only the recently read pages.

A drawing with many large layers would be in memory twice: decoded, and on the graphics card.
"""

import mmap
import tempfile
from contextlib import suppress
from dataclasses import replace
from typing import Final

import numpy as np

from app.storage.pictures.picture import Picture
from engine.arrays import Bytes

# Systems without this call take back the memory themselves when it runs short.
_UNREAD: Final = getattr(mmap, "MADV_DONTNEED", None)


def move_to_disk(picture: Picture) -> Picture:
    """Return a picture with its pixels in a temporary file, or unchanged if the disk is full.

    The file is written before it is mapped: a full disk fails here, and never at a later page.
    """
    pixels = picture.rgba
    with suppress(OSError), tempfile.TemporaryFile() as file:
        file.write(np.ascontiguousarray(pixels).data)
        file.flush()
        mapped = mmap.mmap(file.fileno(), pixels.nbytes, access=mmap.ACCESS_READ)
        return replace(picture, rgba=np.frombuffer(mapped, np.uint8).reshape(pixels.shape))
    return picture


def release_pages(pixels: Bytes) -> None:
    """Release the memory of pixels in a file; the system reads them again on use."""
    base: object = pixels
    while isinstance(base, np.ndarray):
        base = base.base
    if isinstance(base, memoryview):
        base = base.obj
    if isinstance(base, mmap.mmap) and _UNREAD is not None:
        base.madvise(_UNREAD)
