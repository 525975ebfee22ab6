"""Segments that leave a region."""

from collections.abc import Sequence

import numpy as np
import shapely
from scipy import ndimage

from engine.arrays import Booleans, Complexes, Indices, ragged_indices
from engine.geometry import (
    ON_OUTLINE,
    as_xy,
    diameter,
    edge_vectors,
    loop_ends,
    shapely_region,
)

MOST_CELLS = 2000  # cells per diameter, in the search for segments near the boundary


def leave_region(loops: Sequence[Complexes], starts: Complexes, ends: Complexes) -> Booleans:
    """Return which segments leave the region by more than rounding."""
    if not len(starts):
        return np.empty(0, dtype=np.bool_)
    tolerance = 2 * ON_OUTLINE * diameter(loops[0])
    # Nearly all segments are far from the boundary; only the others need the exact test.
    near = np.flatnonzero(_near_boundary(loops, starts, ends))
    segments = shapely.linestrings(np.stack([as_xy(starts[near]), as_xy(ends[near])], axis=1))
    corners = np.concatenate(loops)
    sides = shapely.linestrings(np.stack([as_xy(corners), as_xy(loop_ends(loops))], axis=1))
    touching, _ = shapely.STRtree(sides).query(segments, predicate="dwithin", distance=tolerance)
    touching = np.unique(touching)
    area = shapely_region(loops[0], loops[1:])
    room = area.buffer(tolerance, join_style="mitre")
    shapely.prepare(room)
    crosses = np.zeros(len(starts), dtype=np.bool_)
    crosses[near[touching]] = ~shapely.covers(room, segments[touching])
    return crosses


def _near_boundary(loops: Sequence[Complexes], starts: Complexes, ends: Complexes) -> Booleans:
    """Return which segments may come near the boundary, by a grid of cells.

    Most segments are shorter than a cell. Such a segment stays in the cells around its start. The
    boundary, sampled at points a cell apart, stays in the cells around these points.
    """
    lengths = np.abs(ends - starts)
    cell = max(2 * float(np.median(lengths)), diameter(loops[0]) / MOST_CELLS)
    boundary = np.concatenate([_dense(loop, cell) for loop in loops])
    corner = complex(
        min(boundary.real.min(), starts.real.min()), min(boundary.imag.min(), starts.imag.min())
    )

    def cells(points: Complexes) -> tuple[Indices, Indices]:
        place = (points - corner) / cell
        return place.real.astype(np.intp), place.imag.astype(np.intp)

    size = np.max([*map(np.max, (*cells(boundary), *cells(starts)))]) + 1
    marked = np.zeros((size, size), dtype=np.bool_)
    marked[cells(boundary)] = True
    marked = ndimage.binary_dilation(marked, np.ones((5, 5), dtype=np.bool_))
    return np.asarray(marked[cells(starts)] | (lengths > cell))


def _dense(loop: Complexes, spacing: float) -> Complexes:
    """Return points along a closed polygon, no farther apart than `spacing`."""
    sides = edge_vectors(loop)
    counts = np.ceil(np.abs(sides) / spacing).astype(np.intp) + 1
    side, place = ragged_indices(counts)
    return loop[side] + sides[side] * (place / counts[side])
