"""Thumbnails of files."""

import io
from pathlib import Path
from typing import IO

import numpy as np
from PIL import Image, ImageSequence

from app.errors import LissomError
from app.storage.files.reading import open_file
from app.storage.pictures.mmap_pixels import release_pages
from app.storage.pictures.picture import DECODER_ERRORS, FORMATS, apply_orientation
from app.storage.project_file import load_thumbnail
from engine.arrays import Bytes, readonly

SIDE = 320  # pixels
# Decoding a larger picture takes so long (0.3 s) that the window would freeze. JPEG files are
# decoded at a reduced size.
MOST_PIXELS = 8_000_000
PROJECT = ".lissom"
BOMBS = (Image.DecompressionBombError, Image.DecompressionBombWarning)


def draw_thumbnail(rgba: Bytes, side: int = SIDE) -> bytes:
    """Return a PNG file of a picture, uint8 (h, w, 4), reduced to at most `side` pixels a side."""
    small = Image.fromarray(rgba)
    small.thumbnail((side, side))
    file = io.BytesIO()
    small.save(file, "PNG")
    return file.getvalue()


def shrink_picture(rgba: Bytes, side: int) -> Bytes:
    """Return a picture's opaque part, uint8 (h, w, 4), reduced to at most `side` pixels a side."""
    image = Image.fromarray(rgba)
    drawn = image.crop(image.getchannel("A").getbbox())
    drawn.thumbnail((side, side))
    release_pages(rgba)
    return readonly(np.asarray(drawn))


def read_thumbnail(path: Path) -> Bytes | None:
    """Return a picture or project, uint8 (h, w, 4), reduced to at most `SIDE` pixels a side.

    None if the file is unreadable or slow to read, or if a project has no thumbnail.
    """
    try:
        if path.suffix.lower() == PROJECT:
            content = load_thumbnail(path)
            return None if content is None else _small(io.BytesIO(content), ("PNG",))
        with open_file(path) as (file, _):
            return _small(file, tuple(FORMATS))
    except (LissomError, MemoryError, *DECODER_ERRORS, *BOMBS):
        return None


def read_animation_frames(path: Path) -> list[Bytes]:
    """Return the frames of a small animation, uint8 (h, w, 4); empty if it is unreadable."""
    try:
        with open_file(path) as (file, _), Image.open(file, formats=("WEBP",)) as moving:
            frames = ImageSequence.Iterator(moving)
            return [np.asarray(frame.convert("RGBA")) for frame in frames]
    except (LissomError, MemoryError, *DECODER_ERRORS, *BOMBS):
        return []


def _small(file: IO[bytes], formats: tuple[str, ...]) -> Bytes | None:
    with Image.open(file, formats=formats) as image:
        image.draft("RGB", (SIDE, SIDE))
        if image.width * image.height > MOST_PIXELS:
            return None
        small = image.convert("RGBA")
        small.thumbnail((SIDE, SIDE))
        return np.asarray(apply_orientation(small)[0])
