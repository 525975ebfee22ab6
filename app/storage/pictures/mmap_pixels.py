"""Pixels in an unnamed file; memory holds only the recently read pages.

A drawing with many large layers would be in memory twice: decoded, and on the graphics card.
"""

import mmap
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Final

import numpy as np

from app.storage.pictures.picture import Picture
from engine.arrays import Bytes

# Systems without this call take back the memory themselves when it runs short.
_UNREAD: Final = getattr(mmap, "MADV_DONTNEED", None)


def move_to_disk(pictures: Sequence[Picture]) -> list[Picture]:
    """Return pictures with their pixels in a temporary file, or unchanged if the disk is full.

    All share a file: a system opens only some hundred files at a time. The file is written before
    it is mapped: a full disk fails here, and never at a later page.
    """
    with suppress(OSError), tempfile.TemporaryFile() as file:
        starts = []
        for picture in pictures:
            starts.append(file.tell())
            file.write(np.ascontiguousarray(picture.rgba).data)
            # Pages are released one by one.
            file.write(bytes(-file.tell() % mmap.PAGESIZE))
        file.flush()
        mapped = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        return [
            replace(picture, rgba=_pixels(mapped, start, picture.rgba))
            for picture, start in zip(pictures, starts, strict=True)
        ]
    return list(pictures)


def _pixels(mapped: mmap.mmap, start: int, pixels: Bytes) -> Bytes:
    return np.frombuffer(mapped, np.uint8, pixels.size, start).reshape(pixels.shape)


def release_pages(pixels: Bytes) -> None:
    """Release the memory of pixels in a file; the system reads them again on use."""
    base: object = pixels
    while isinstance(base, np.ndarray):
        base = base.base
    if isinstance(base, memoryview):
        base = base.obj
    if isinstance(base, mmap.mmap) and _UNREAD is not None:
        start = pixels.ctypes.data - np.frombuffer(base, np.uint8).ctypes.data
        first = start - start % mmap.PAGESIZE
        base.madvise(_UNREAD, first, min(start + pixels.nbytes, len(base)) - first)
