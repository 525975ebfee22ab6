"""The base of all readers of footage."""

from abc import ABC, abstractmethod
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple, Self

from app.errors import LissomError
from app.texts import N_, _
from engine.arrays import Bytes

CUT_SHORT = N_("{name} is damaged or cut short; its picture {number:,} cannot be read")


class DecodedPicture(NamedTuple):
    """A picture that a reader has reached; its pixels are converted on demand."""

    number: int  # from 0
    pixels: Callable[[], Bytes]  # uint8 (h, w, 4), straight alpha, first row on top


class FootageReader(ABC):
    """Reads the pictures of an open file of footage in any order; for one thread at a time.

    Parameters
    ----------
    name : str
        The file's name in errors.
    starts : sequence of int
        Numbers of the pictures that can be decoded without the pictures before them, from 0 on.
    """

    def __init__(self, name: str, starts: Sequence[int] = (0,)) -> None:
        self.name = name
        self._starts = starts
        self._pictures: Iterator[DecodedPicture] = iter(())
        self._next: int | None = None  # number of the next picture

    def decode_to(self, number: int) -> Iterator[DecodedPicture]:
        """Yield the pictures that are decoded on the way to a picture; the last one is the picture.

        Raises `LissomError` if the picture cannot be read.
        """
        start = self._starts[bisect_right(self._starts, number) - 1]
        if self._next is None or not start <= self._next <= number:
            self._pictures, self._next = self._decode_from(start), start
        for decoded in self._pictures:
            self._next = decoded.number + 1
            # A file may lack a picture; the next one replaces it.
            yield decoded._replace(number=min(decoded.number, number))
            if decoded.number >= number:
                return
        self._next = None
        raise LissomError(_(CUT_SHORT).format(name=self.name, number=number + 1))

    def read(self, number: int) -> Bytes:
        """Return the pixels of a picture, uint8 (h, w, 4), straight alpha.

        Raises `LissomError` if the picture cannot be read.
        """
        *_passed, decoded = self.decode_to(number)
        return decoded.pixels()

    @abstractmethod
    def _decode_from(self, start: int) -> Iterator[DecodedPicture]:
        """Yield the pictures from one of `starts` on."""

    @abstractmethod
    def close(self) -> None:
        """Close the file."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()
