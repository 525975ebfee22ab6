"""Triangulations as values, and quantities of their triangles and edges."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Complexes, Floats, Indices, Integers, readonly


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Mesh:
    """A triangulation of a plane domain.

    `triangles` (m, 3) are counter-clockwise indices of vertices.
    """

    vertices: Complexes
    triangles: Integers

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", readonly(self.vertices))
        object.__setattr__(self, "triangles", readonly(self.triangles))

    def areas(self) -> Floats:
        """Return the signed area (m,) of each triangle, positive where counter-clockwise."""
        return signed_areas(self.vertices, self.triangles)

    def smallest_angles(self) -> Floats:
        """Return the smallest angle (m,) of each triangle, in degrees."""
        return smallest_angles(self.vertices, self.triangles)

    def edges(self) -> Integers:
        """Return the undirected edges (e, 2), each once, the smaller index first, in order."""
        ends = np.concatenate([self.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        ends.sort(axis=1)
        # One sorted 64-bit key for each edge: much faster than `np.unique`, of rows or of keys.
        keys = np.sort(ends[:, 0].astype(np.int64) << 32 | ends[:, 1])
        keys = keys[np.diff(keys, prepend=-1) > 0]
        return np.column_stack([keys >> 32, keys & 0xFFFFFFFF]).astype(np.int32)


def border_edges(triangles: Integers) -> Integers:
    """Return the edges (e, 2) of only one triangle, the triangle on their left."""
    edges = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)]).astype(np.int64)
    keys = edges.min(axis=1) << 32 | edges.max(axis=1)
    _, first, count = np.unique(keys, return_index=True, return_counts=True)
    border: Integers = edges[first[count == 1]].astype(np.int32)
    return border


def sides_of(triangles: Integers | Indices) -> tuple[Indices, Indices, Indices]:
    """Find the sides of triangles (m, 3), and the sides that two triangles share.

    Returns
    -------
    sides : intp, shape (e, 2)
        As `Mesh.edges` has them.
    numbers : intp, shape (m, 3)
        The side from each corner of a triangle to its next.
    counterparts : intp, shape (p, 2)
        For each shared side, in order, its two positions in the flattened `numbers`.
    """
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    low, high = ends.min(axis=1).astype(np.intp), ends.max(axis=1)
    keys = low << 32 | high
    order = np.argsort(keys, kind="stable")
    is_new = np.diff(keys[order], prepend=-1) > 0
    numbers = np.empty_like(order)
    numbers[order] = np.cumsum(is_new) - 1
    again = np.flatnonzero(~is_new)
    counterparts = np.column_stack([order[again - 1], order[again]])
    return np.column_stack([low, high])[order[is_new]], numbers.reshape(-1, 3), counterparts


def signed_areas(vertices: Complexes, triangles: Integers | Indices) -> Floats:
    """Return the signed area (m,) of each triangle, positive where counter-clockwise."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    # From edge vectors, not from coordinates: exact enough far from the origin, too.
    return 0.5 * ((b - a).conj() * (c - a)).imag


def smallest_angles(vertices: Complexes, triangles: Integers | Indices) -> Floats:
    """Return the smallest angle (m,) of each triangle, in degrees, 0 for a flat one."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    corners = [(c - a) * (b - a).conj(), (a - b) * (c - b).conj(), (b - c) * (a - c).conj()]
    smallest = np.min([np.arctan2(np.maximum(w.imag, 0.0), w.real) for w in corners], axis=0)
    return np.asarray(np.degrees(smallest))
