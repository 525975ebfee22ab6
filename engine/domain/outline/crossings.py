"""Where edges of polygons meet that should not."""

import numpy as np

from engine.arrays import Booleans, Complexes, Floats


def crossing_edges(polygon: Complexes, other: Complexes) -> Booleans:
    """Tell for each edge of one polygon (n,) and of another (m,) whether they meet, (n, m)."""
    start, end = polygon[:, None], np.roll(polygon, -1)[:, None]
    other_start, other_end = other[None, :], np.roll(other, -1)[None, :]
    sides = _side(start, end, other_start) * _side(start, end, other_end)
    other_sides = _side(other_start, other_end, start) * _side(other_start, other_end, end)
    # On one line, the sides say nothing: only boxes that meet count.
    return np.asarray(
        (sides <= 0)
        & (other_sides <= 0)
        & _overlap(start.real, end.real, other_start.real, other_end.real)
        & _overlap(start.imag, end.imag, other_start.imag, other_end.imag)
    )


def self_crossings(polygon: Complexes) -> Booleans:
    """Tell for each pair of edges of a polygon (n, n) whether they meet; neighbours never do."""
    n = len(polygon)
    meet = crossing_edges(polygon, polygon)
    here = np.arange(n)
    for step in (-1, 0, 1):
        meet[here, (here + step) % n] = False
    return meet


def _side(start: Complexes, end: Complexes, point: Complexes) -> Floats:
    """Return -1, 0 or 1: to which side of the line from start to end the point lies."""
    return np.sign(((end - start).conj() * (point - start)).imag)


def _overlap(a: Floats, b: Floats, c: Floats, d: Floats) -> Booleans:
    """Tell whether the intervals between a and b and between c and d meet."""
    return (np.minimum(a, b) <= np.maximum(c, d)) & (np.minimum(c, d) <= np.maximum(a, b))
