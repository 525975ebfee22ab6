"""Forbidden contacts between edges of polygons."""

import numpy as np
import shapely

from engine.arrays import Booleans, Complexes, Indices
from engine.geometry import as_xy


def find_meeting_edges(polygon: Complexes, other: Complexes) -> tuple[Booleans, Booleans]:
    """Mark the edges of a polygon (n,) and of another (m,) that meet the other polygon."""
    own, met = _meetings(polygon, other)
    marks = np.zeros(len(polygon), dtype=np.bool_), np.zeros(len(other), dtype=np.bool_)
    marks[0][own] = True
    marks[1][met] = True
    return marks


def find_crossing_edges(polygon: Complexes) -> Booleans:
    """Mark the edges (n,) of a polygon that meet another of its edges, except neighbours."""
    n = len(polygon)
    first, second = _meetings(polygon, polygon)
    apart = (second - first) % n
    crossing = np.zeros(n, dtype=np.bool_)
    crossing[first[(apart > 1) & (apart < n - 1)]] = True
    return crossing


def _meetings(polygon: Complexes, other: Complexes) -> tuple[Indices, Indices]:
    """Return the pairs of edges of two polygons that meet; O(n log n) if they are few."""
    first, second = shapely.STRtree(_edges(other)).query(_edges(polygon), predicate="intersects")
    return first, second


def _edges(polygon: Complexes) -> np.ndarray:
    ends = np.stack([as_xy(polygon), as_xy(np.roll(polygon, -1))], axis=1)
    return np.asarray(shapely.linestrings(ends))
