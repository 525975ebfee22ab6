"""The lattice of equilateral triangles inside polygons."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.geometry import loop_ends

ROW_HEIGHT = 3.0**0.5 / 2
"""Distance between neighbouring rows over the spacing of the points in a row."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Lattice:
    """Points of the triangular lattice, sorted by row, then by column.

    Every odd row is shifted right by half a spacing.

    Parameters
    ----------
    columns, rows : int64, shape (s,)
        Where the points are in the lattice.
    points : complex128, shape (s,)
        Where they are in the plane.
    """

    columns: Indices
    rows: Indices
    points: Complexes

    def select(self, which: Booleans) -> "Lattice":
        """Return the lattice of the points marked in `which` (s,)."""
        return Lattice(
            columns=self.columns[which], rows=self.rows[which], points=self.points[which]
        )


def lattice_inside(loops: Sequence[Complexes], spacing: float) -> Lattice:
    """Fill a region with the points of a lattice, row by row (scan conversion).

    Points within rounding of the boundary may fall on either side.

    Parameters
    ----------
    loops : sequence of complex128
        A simple polygon, and those of its holes.
    spacing : float
        Distance between neighbouring points.
    """
    starts, ends = np.concatenate(loops), loop_ends(loops)
    origin = complex(starts.real.min(), starts.imag.min())
    row, x = _crossings(starts, ends, origin.imag, spacing)
    row, left, right = row[0::2], x[0::2], x[1::2]
    shift = origin.real + 0.5 * spacing * (row % 2)
    first = np.ceil((left - shift) / spacing).astype(np.intp)
    last = np.floor((right - shift) / spacing).astype(np.intp)
    run, place = _runs(np.maximum(last - first + 1, 0))
    columns, rows = first[run] + place, row[run]
    x = shift[run] + columns * spacing
    y = origin.imag + (rows + 0.5) * (ROW_HEIGHT * spacing)
    return Lattice(columns=columns, rows=rows, points=x + 1j * y)


def lattice_triangles(lattice: Lattice) -> Indices:
    """Return the unit triangles (m, 3), counter-clockwise, that have all three corners here."""
    if not len(lattice.rows):
        return np.empty((0, 3), dtype=np.intp)
    first = lattice.columns.min()
    # Two spare columns, so that the neighbours of a row's last point are not found in the next row.
    width = int(np.ptp(lattice.columns)) + 3
    keys = lattice.rows * width + (lattice.columns - first + 1)
    odd = lattice.rows % 2
    own = np.arange(len(keys))
    east = _find(keys, keys + 1)
    north_east = _find(keys, keys + width + odd)
    north_west = _find(keys, keys + width + odd - 1)
    upward = (east >= 0) & (north_east >= 0)
    downward = (north_east >= 0) & (north_west >= 0)
    return np.concatenate(
        [
            np.column_stack([own, east, north_east])[upward],
            np.column_stack([own, north_east, north_west])[downward],
        ]
    )


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
    edge, place = _runs(highest - lowest)
    row = lowest[edge] + place
    fraction = (row - level[edge]) / (next_level[edge] - level[edge])
    x = starts.real[edge] + fraction * along.real[edge]
    order = np.lexsort((x, row))
    return row[order], x[order]


def _runs(lengths: Indices) -> tuple[Indices, Indices]:
    """Return, for runs of the given lengths laid end to end, the run and the place in it."""
    run = np.repeat(np.arange(len(lengths)), lengths)
    return run, np.arange(len(run)) - (np.cumsum(lengths) - lengths)[run]


def _find(keys: Indices, wanted: Indices) -> Indices:
    """Return where each wanted key stands in the sorted keys, or -1."""
    place = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return np.where(keys[place] == wanted, place, -1)
