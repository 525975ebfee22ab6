"""Straight segments: distances from points, and pieces by repeated halving."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pieces:
    """Dyadic pieces of segments, in order of the segments and along each of them.

    Build them with `Pieces.whole`, and cut them with `halved` or `bisect_segments`.

    Parameters
    ----------
    origin, span : complex128, shape (s,)
        Start of each segment, and the vector to its end.
    segment : intp, shape (c,)
        The segment of each piece.
    place, width : float64, shape (c,)
        Start and length of the piece, as shares of its segment: exact numbers.
    """

    origin: Complexes
    span: Complexes
    segment: Indices
    place: Floats
    width: Floats

    @classmethod
    def whole(cls, starts: Complexes, ends: Complexes) -> Self:
        """Return every segment (s,) as one piece."""
        count = len(starts)
        return cls(
            origin=starts,
            span=ends - starts,
            segment=np.arange(count),
            place=np.zeros(count),
            width=np.ones(count),
        )

    def __len__(self) -> int:
        return len(self.segment)

    @property
    def starts(self) -> Complexes:
        """Starts of the pieces (c,)."""
        return self.origin[self.segment] + self.place * self.span[self.segment]

    @property
    def ends(self) -> Complexes:
        """Ends of the pieces (c,); the end of a piece is exactly the start of its neighbour."""
        return self.origin[self.segment] + (self.place + self.width) * self.span[self.segment]

    @property
    def lengths(self) -> Floats:
        return self.width * np.abs(self.span[self.segment])

    def select(self, chosen: Booleans) -> "Pieces":
        segment, place, width = self.segment[chosen], self.place[chosen], self.width[chosen]
        return replace(self, segment=segment, place=place, width=width)

    def halved(self, chosen: Booleans) -> "Pieces":
        """Return the pieces with two halves in place of each piece marked in `chosen` (c,)."""
        parent = np.repeat(np.arange(len(self)), 1 + chosen)
        second = np.diff(parent, prepend=-1) == 0
        width = np.where(chosen, self.width / 2, self.width)[parent]
        place = self.place[parent] + second * width
        return replace(self, segment=self.segment[parent], place=place, width=width)


def bisect_segments(pieces: Pieces, is_fine: Callable[[Pieces], Booleans]) -> Pieces:
    """Halve pieces until each of them is fine.

    `is_fine` decides for pieces (c,); it is asked about every piece once.
    """
    new = np.ones(len(pieces), dtype=np.bool_)
    while True:
        coarse = new.copy()
        coarse[new] = ~is_fine(pieces.select(new))
        if not coarse.any():
            return pieces
        pieces = pieces.halved(coarse)
        new = np.repeat(coarse, 1 + coarse)


def distance_to_segments(points: Complexes, starts: Complexes, ends: Complexes) -> Floats:
    """Return the distances (p, s) between each of p points and each of s segments."""
    along = ends - starts
    offset = points[:, None] - starts
    length2 = np.maximum(np.abs(along) ** 2, np.finfo(np.float64).tiny)
    parameter = np.clip((offset * along.conj()).real / length2, 0.0, 1.0)
    return np.asarray(np.abs(offset - parameter * along))


def arc_lengths(line: Complexes) -> Floats:
    """Return the length of a line through points (n,) up to each of them."""
    return np.append(0.0, np.cumsum(np.abs(np.diff(line))))
