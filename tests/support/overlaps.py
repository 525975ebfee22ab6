"""Where a posed mesh lies over itself."""

import numpy as np
import scipy.sparse
import shapely
from scipy.sparse.csgraph import connected_components

from engine.arrays import Complexes, Indices, Integers

SHRUNK = 0.9  # triangles that merely touch do not overlap


def overlaps(positions: Complexes, triangles: Integers) -> tuple[Indices, Indices]:
    """Find the pairs of triangles that overlap, and which pairs are of the same two sheets.

    Returns
    -------
    pairs : int64, shape (p, 2)
        Each pair twice, once each way round.
    overlap : int64, shape (p,)
        The same number for pairs that neighbours lead from one to the other.
    """
    count = len(triangles)
    corners = positions[triangles]
    corners = corners.mean(axis=1, keepdims=True) * (1 - SHRUNK) + corners * SHRUNK
    shapes = shapely.polygons(np.stack([corners.real, corners.imag], axis=-1))
    pairs = shapely.STRtree(shapes).query(shapes, predicate="intersects").T
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    keys = np.unique(pairs @ (count, 1))
    pairs = np.column_stack(np.divmod(keys, count))

    around = neighbours(triangles)
    steps = []
    for side in (0, 1):
        for step in around.T:
            beside = pairs.copy()
            beside[:, side] = step[pairs[:, side]]
            sought = beside @ (count, 1)
            found = np.searchsorted(keys, sought).clip(max=len(keys) - 1)
            linked = (beside[:, side] >= 0) & (keys[found] == sought)
            steps.append(np.column_stack([np.flatnonzero(linked), found[linked]]))
    links = np.concatenate(steps)
    graph = scipy.sparse.coo_array((np.ones(len(links)), links.T), shape=(len(keys), len(keys)))
    return pairs, connected_components(graph, directed=False)[1]


def neighbours(triangles: Integers) -> Indices:
    """Return the triangles (m, 3) beyond the sides of each, −1 where there is none."""
    sides = np.stack([triangles[:, [k, (k + 1) % 3]] for k in range(3)], axis=1).reshape(-1, 2)
    keys = np.sort(sides.astype(np.int64), axis=1) @ (triangles.max() + 1, 1)
    order = np.argsort(keys, kind="stable")
    same = np.flatnonzero(np.diff(keys[order]) == 0)
    beyond = np.full(len(keys), -1)
    one, other = order[same], order[same + 1]
    beyond[one], beyond[other] = other // 3, one // 3
    return beyond.reshape(-1, 3)
