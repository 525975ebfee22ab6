"""A quadtree of points, built level by level."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Booleans, Complexes, Floats, Indices

DEEPEST = 26  # levels of squares below the first
# Shifts and masks that put zeros between the bits of a number, by halves.
_SPREADING = (
    (16, 0x0000FFFF0000FFFF),
    (8, 0x00FF00FF00FF00FF),
    (4, 0x0F0F0F0F0F0F0F0F),
    (2, 0x3333333333333333),
    (1, 0x5555555555555555),
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Squares:
    """A quadtree of points; the squares of each level come after those of the level above.

    Attributes
    ----------
    order : intp, shape (t,)
        The points, so that those of a square follow each other.
    starts, ends : intp, shape (q,)
        Range of the points of each square, in `order`.
    centre, radius : complex128 and float64, shape (q,)
        Disc around each square; a quarter has half the radius.
    parent : intp, shape (q,)
        The square that contains this quarter; the first square is its own parent.
    quadrant : intp, shape (q,)
        Position within the parent: bit 0 is right, bit 1 up.
    leaves : intp, shape (l,)
        Uncut squares, in the order of their points.
    levels : tuple of slice
        The squares of each level.
    """

    order: Indices
    starts: Indices
    ends: Indices
    centre: Complexes
    radius: Floats
    parent: Indices
    quadrant: Indices
    leaves: Indices
    levels: tuple[slice, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Grid:
    """The points on a grid of 2^DEEPEST lines, in Morton order: x and y bit by bit in turn.

    `corner` and `side` define the square around all points. `order` (t,) are the points in Morton
    order, `codes` (t,) their Morton codes.
    """

    corner: complex
    side: float
    order: Indices
    codes: npt.NDArray[np.int64]

    @classmethod
    def around(cls, points: Complexes) -> Self:
        """Sort points (t,)."""
        corner = complex(points.real.min(), points.imag.min())
        extent = max(float(np.ptp(points.real)), float(np.ptp(points.imag)))
        # A single point has no extent, but expansions need a radius.
        side = max(extent, 1e-12 * float(np.abs(points).max()), 1e-100) * (1 + 2.0**-DEEPEST)
        scaled = (points - corner) * (2**DEEPEST / side)
        codes = _spread(scaled.real.astype(np.int64)) | _spread(scaled.imag.astype(np.int64)) << 1
        order = np.argsort(codes, kind="stable")
        return cls(corner=corner, side=side, order=order, codes=codes[order])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Level:
    """Squares of one size: `first` is the number of the first one, `code` the Morton codes.

    The other fields are those of `Squares`.
    """

    depth: int
    first: int
    code: npt.NDArray[np.int64]
    starts: Indices
    ends: Indices
    centre: Complexes
    radius: float
    parent: Indices
    quadrant: Indices

    @classmethod
    def whole(cls, grid: Grid) -> Self:
        """Return the square around all points."""
        none = np.zeros(1, dtype=np.intp)
        return cls(
            depth=0,
            first=0,
            code=np.zeros(1, dtype=np.int64),
            starts=none,
            ends=np.array([len(grid.order)]),
            centre=np.array([grid.corner + grid.side * (0.5 + 0.5j)]),
            radius=grid.side / np.sqrt(2),
            parent=none,
            quadrant=none,
        )

    def quarters(self, grid: Grid, cut: Booleans) -> Self:
        """Return the non-empty quarters of the cut squares (q,)."""
        chosen = np.flatnonzero(cut)
        depth = self.depth + 1
        code = (4 * self.code[chosen, None] + np.arange(4)).ravel()
        bounds = np.array([code, code + 1]) << 2 * (DEEPEST - depth)
        starts, ends = np.searchsorted(grid.codes, bounds)
        there = starts < ends
        parent = np.repeat(chosen, 4)[there]
        quadrant = np.tile(np.arange(4), len(chosen))[there]
        towards = (2 * (quadrant & 1) - 1) + 1j * (2 * (quadrant >> 1) - 1)
        return type(self)(
            depth=depth,
            first=self.first + len(self.starts),
            code=code[there],
            starts=starts[there],
            ends=ends[there],
            centre=self.centre[parent] + towards * (grid.side / 2 ** (depth + 1)),
            radius=self.radius / 2,
            parent=parent + self.first,
            quadrant=quadrant,
        )


def _spread(numbers: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Put a zero between the bits of numbers below 2^32."""
    spread = numbers
    for shift, mask in _SPREADING:
        spread = (spread | spread << shift) & mask
    return spread
