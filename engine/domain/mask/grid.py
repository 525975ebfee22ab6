"""Grids of cells over a picture's pixels, neither too coarse nor too fine for the algorithms.

Large masks are reduced to square blocks of pixels, without loss of any pixel; the pixels of small
masks are enlarged.
"""

from dataclasses import dataclass
from functools import reduce

import numpy as np

from engine.arrays import Booleans, Complexes
from engine.errors import EngineError

LONGEST = 1024  # cells along the subject's longer side: larger subjects are reduced to blocks
ENLARGED = 640  # cells to which small subjects are enlarged, at most
MOST_ENLARGED = 16  # cells per pixel
EMPTY_MASK = "The mask selects no pixels; give a mask that selects a drawing."
PADDING = 0.06  # of the diagonal: free space around the subject


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WorkingGrid:
    """A mask around the subject, y up: cell (r, c) is the square [c, c + 1] × [r, r + 1].

    Parameters
    ----------
    mask : bool, shape (h, w)
        Row 0 at the bottom; True on each cell that holds a part of a subject's pixel.
    cell : float
        Side of a cell in pixels of the picture.
    origin : complex
        Lower left corner of the grid in the picture, y up from the picture's lower edge.
    diagonal : float
        Of the subject's box, in cells.
    """

    mask: Booleans
    cell: float
    origin: complex
    diagonal: float

    def to_picture(self, points: Complexes) -> Complexes:
        """Return points of the grid in the picture's pixels."""
        return self.origin + self.cell * points

    def to_cells(self, points: Complexes) -> Complexes:
        """Return points of the picture, y up, in cells."""
        return (points - self.origin) / self.cell


def working_grid(mask: Booleans) -> WorkingGrid:
    """Cut the subject out of its mask, first row on top, and bring it to a good size.

    A block of a large subject counts if one of its pixels does, so that the grid's subject covers
    the picture's. Each pixel of a small subject becomes several cells.
    """
    if not mask.any():
        raise EngineError(EMPTY_MASK)
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    cut = mask[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1][::-1]
    corner = complex(columns[0], mask.shape[0] - 1 - rows[-1])
    factor = block_factor(cut.shape, LONGEST)
    enlarging = int(np.clip(ENLARGED // max(cut.shape), 1, MOST_ENLARGED))
    if factor > 1:
        cells, cell = reduce_blocks(cut, factor, np.logical_or), float(factor)
    else:
        shape = (cut.shape[0] * enlarging, cut.shape[1] * enlarging)
        cells, cell = repeat_blocks(cut, enlarging, shape), 1 / enlarging
    diagonal = float(np.hypot(*cells.shape))
    padding = int(np.ceil(PADDING * diagonal)) + 2 * enlarging + 4
    return WorkingGrid(
        mask=np.pad(cells, padding),
        cell=cell,
        origin=corner - cell * padding * (1 + 1j),
        diagonal=diagonal,
    )


def block_factor(shape: tuple[int, ...], longest: int) -> int:
    """Return the block side, in pixels, at which no side of `shape` has over `longest` blocks."""
    return max(1, -(-max(shape) // longest))


def reduce_blocks(mask: Booleans, factor: int, combine: np.ufunc) -> Booleans:
    """Combine the pixels (h, w) of each block into one (ceil(h / factor), ceil(w / factor)).

    Blocks at the end of a row or column may be incomplete. `combine` is `np.logical_or` for any
    pixel of a block, `np.logical_and` for all.
    """
    missing = [(0, -side % factor) for side in mask.shape]
    whole = np.pad(mask, missing, constant_values=combine.identity)
    # Ten times as fast as `combine.reduce` and `reduceat`, which go pixel by pixel.
    rows = reduce(combine, [whole[row::factor] for row in range(factor)])
    return reduce(combine, [rows[:, column::factor] for column in range(factor)])


def repeat_blocks(blocks: Booleans, factor: int, shape: tuple[int, ...]) -> Booleans:
    """Spread each block over its pixels; `shape` cuts off the last ones."""
    pixels = np.repeat(np.repeat(blocks, factor, axis=0), factor, axis=1)
    return pixels[: shape[0], : shape[1]]
