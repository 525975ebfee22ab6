"""Animated pictures of one file, read by Pillow: GIF, APNG, WebP, AVIF and TIFF."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np

from app.errors import LissomError
from app.storage.files.reading import read_file
from app.storage.footage.footage_reader import CUT_SHORT, DecodedPicture, FootageReader
from app.storage.pictures.colour import to_srgb
from app.storage.pictures.picture import decoding_errors, open_image
from app.texts import _
from engine.arrays import Bytes, freeze

# Players show pictures with a shorter delay for a tenth of a second.
_SHORTEST, _USUAL = 20, 100  # milliseconds


class AnimatedReader(FootageReader):
    """Reads an animated picture from its beginning, and anew for an earlier picture."""

    def __init__(self, path: Path) -> None:
        super().__init__(path.name)
        self._data = read_file(path)
        with decoding_errors(self._data, path.name), open_image(self._data) as image:
            self.size: Final = image.size
            # The picture for programs without animation is not part of it.
            self._first = int(bool(image.info.get("default_image")))
            self.picture_count: Final = getattr(image, "n_frames", 1) - self._first

    def delays(self) -> list[int] | None:
        """Return for how many milliseconds each picture is shown; None if the file has no times."""
        found = []
        with decoding_errors(self._data, self.name), open_image(self._data) as image:
            for number in range(self.picture_count):
                if image.format == "TIFF":
                    return None
                image.seek(number + self._first)
                image.load()
                delay = image.info.get("duration", 0)
                found.append(_USUAL if delay < _SHORTEST else round(delay))
        return found

    def _decode_from(self, start: int) -> Iterator[DecodedPicture]:
        with open_image(self._data) as image:
            for number in range(start, self.picture_count):
                with decoding_errors(self._data, self.name):
                    image.seek(number + self._first)
                    if image.size != self.size:
                        raise LissomError(_(CUT_SHORT).format(name=self.name, number=number + 1))
                    image.load()
                    coloured, _notice = to_srgb(image.copy(), image.info.get("icc_profile"))
                    shown = np.asarray(coloured.convert("RGBA"))

                def pixels(shown: Bytes = shown) -> Bytes:
                    return freeze(shown)

                yield DecodedPicture(number, pixels)

    def close(self) -> None:
        """Forget the file."""
        self._data = b""
