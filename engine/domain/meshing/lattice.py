"""The lattice of equilateral triangles inside polygons."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices, ragged_indices
from engine.geometry import loop_ends

ROW_HEIGHT = 3.0**0.5 / 2  # distance between neighbouring rows over the spacing in a row


class Lattice(NamedTuple):
    """Points (s,) of the triangular lattice, sorted by row, then by column.

    Every odd row is shifted right by half a spacing.
    """

    columns: Indices
    rows: Indices
    points: Complexes  # in the plane

    def select(self, which: Booleans) -> "Lattice":
        """Return the lattice of the points marked in `which` (s,)."""
        return Lattice(self.columns[which], self.rows[which], self.points[which])


def lattice_inside(loops: Sequence[Complexes], spacing: float) -> Lattice:
    """Fill a simple polygon, less its holes, with lattice points by scan conversion.

    Points within rounding of the boundary may fall on either side.
    """
    starts, ends = np.concatenate(loops), loop_ends(loops)
    origin = complex(starts.real.min(), starts.imag.min())
    row, x = _crossings(starts, ends, origin.imag, spacing)
    row, left, right = row[0::2], x[0::2], x[1::2]
    shift = origin.real + 0.5 * spacing * (row % 2)
    first = np.ceil((left - shift) / spacing).astype(np.intp)
    last = np.floor((right - shift) / spacing).astype(np.intp)
    run, place = ragged_indices(np.maximum(last - first + 1, 0))
    columns, rows = first[run] + place, row[run]
    x = shift[run] + columns * spacing
    y = origin.imag + (rows + 0.5) * (ROW_HEIGHT * spacing)
    return Lattice(columns, rows, x + 1j * y)


def lattice_triangles(lattice: Lattice) -> Indices:
    """Return the unit triangles (m, 3), counter-clockwise, with three corners in the lattice."""
    if not len(lattice.rows):
        return np.empty((0, 3), dtype=np.intp)
    first = lattice.columns.min()
    # Two spare columns, so that a row's last point has no neighbours in the next row.
    width = int(np.ptp(lattice.columns)) + 3
    keys = lattice.rows * width + (lattice.columns - first + 1)
    odd = lattice.rows % 2
    own = np.arange(len(keys))
    east = _find(keys, keys + 1)
    north_east = _find(keys, keys + width + odd)
    north_west = _find(keys, keys + width + odd - 1)
    upward = np.column_stack([own, east, north_east])
    downward = np.column_stack([own, north_east, north_west])
    units = np.concatenate([upward, downward])
    return units[(units >= 0).all(axis=1)]


def _crossings(
    starts: Complexes, ends: Complexes, bottom: float, spacing: float
) -> tuple[Indices, Floats]:
    """Return row and x of each crossing of the boundary's edges with a row, in order.

    An edge owns its lower end and not its upper one, so that every row is crossed an even number
    of times.
    """
    height = ROW_HEIGHT * spacing
    along = ends - starts
    level = (starts.imag - bottom) / height - 0.5
    next_level = (ends.imag - bottom) / height - 0.5
    lowest = np.ceil(np.minimum(level, next_level)).astype(np.intp)
    highest = np.ceil(np.maximum(level, next_level)).astype(np.intp)
    edge, place = ragged_indices(highest - lowest)
    row = lowest[edge] + place
    fraction = (row - level[edge]) / (next_level[edge] - level[edge])
    x = starts.real[edge] + fraction * along.real[edge]
    order = np.lexsort((x, row))
    return row[order], x[order]


def _find(keys: Indices, wanted: Indices) -> Indices:
    """Return the index of each wanted key in the sorted keys, or -1."""
    place = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return np.where(keys[place] == wanted, place, -1)
