"""Numbered pictures: files of a folder whose names differ only in a number."""

import re
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

from app.errors import LissomError
from app.storage.files.reading import read_file
from app.storage.footage.footage_reader import DecodedPicture, FootageReader
from app.storage.pictures.picture import decode_picture
from app.texts import N_, _
from engine.arrays import Bytes

# The last number of a name, before its ending.
_NUMBERED = re.compile(r"(?P<before>.*?)(?P<number>\d+)(?P<after>\D*\.[^.\d][^.]*)")
OTHER_SIZE = N_(
    "{name} has {width} × {height} pixels, but the footage has {own_width} × {own_height}; save "
    "all pictures with the same size"
)


class NumberedPictures(NamedTuple):
    """The pictures of a folder that belong to one of them, in the order of their numbers."""

    paths: list[Path]
    numbers: list[int]

    @property
    def gaps(self) -> list[tuple[int, int]]:
        """The first and the last number of each gap."""
        pairs = zip(self.numbers, self.numbers[1:], strict=False)
        return [(before + 1, after - 1) for before, after in pairs if after > before + 1]

    @property
    def holds(self) -> tuple[int, ...]:
        """How many frames each picture lasts: the picture before a gap holds."""
        pairs = zip(self.numbers, self.numbers[1:], strict=False)
        return (*(after - before for before, after in pairs), 1)


def find_numbered_pictures(path: Path) -> NumberedPictures:
    """Return the pictures whose names differ from a picture's name only in their last number.

    Without a number in the name, the picture is alone. Of two files with the same number, the one
    with as many digits as the given name counts.
    """
    given = _NUMBERED.fullmatch(path.name)
    if given is None:
        return NumberedPictures([path], [0])
    found: dict[int, Path] = {}
    for each in sorted(path.parent.iterdir()):
        match = _NUMBERED.fullmatch(each.name)
        if match is None or any(match[part] != given[part] for part in ("before", "after")):
            continue
        number, is_as_long = int(match["number"]), len(match["number"]) == len(given["number"])
        if number not in found or is_as_long:
            found[number] = each
    found[int(given["number"])] = path
    numbers = sorted(found)
    return NumberedPictures([found[number] for number in numbers], numbers)


class NumberedReader(FootageReader):
    """Reads numbered pictures; each has a file of its own."""

    def __init__(self, paths: list[Path], size: tuple[int, int]) -> None:
        super().__init__(paths[0].name, range(len(paths)))
        self._paths, self._size = paths, size

    def _decode_from(self, start: int) -> Iterator[DecodedPicture]:
        for number in range(start, len(self._paths)):
            yield DecodedPicture(number, partial(self._pixels, self._paths[number]))

    def _pixels(self, path: Path) -> Bytes:
        picture = decode_picture(read_file(path), path.name)
        if picture.size != self._size:
            width, height = picture.size
            raise LissomError(
                _(OTHER_SIZE).format(
                    name=path.name,
                    width=width,
                    height=height,
                    own_width=self._size[0],
                    own_height=self._size[1],
                )
            )
        return picture.rgba

    def close(self) -> None:
        """Do nothing: no file stays open."""
