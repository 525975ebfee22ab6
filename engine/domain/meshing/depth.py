"""Depth: values that spread from points of a shape, and the painting order that follows."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import dijkstra

from engine.arrays import Complexes, Floats, Indices, Integers, readonly
from engine.domain.meshing.half_edges import following, preceding
from engine.domain.meshing.mesh import Mesh, sides_of, signed_areas

# Of the extent; up to there the depth is the point's own. Two limbs that are both this near have
# equal depth, and keep their order.
PLATEAU = 0.5
# Of the range from 0 to 1. Smaller differences count as equal depth.
FINEST = 1e-3


def spread_depth(
    mesh: Mesh,
    paths: scipy.sparse.csr_array,
    points: Complexes,
    depths: Sequence[float],
    extents: Sequence[float],
) -> Floats:
    """Spread the depths of points over a shape, along it and never across a gap.

    Parameters
    ----------
    mesh : Mesh
        Of the shape at rest.
    paths : sparse array, shape (v, v)
        Its `find_paths`.
    points : complex128, shape (p,)
        In the shape; each is moved to the nearest vertex.
    depths : sequence of float
        Of each point, from −1, behind, to 1, in front.
    extents : sequence of float
        Distance from each point at which its depth falls to 0, in the unit of the mesh.

    Returns
    -------
    float64, shape (v,)
        Within the extent of one point, its depth times a weight that is 1 up to half its extent and
        falls smoothly to 0. Within several extents, their mean, which equals each depth at its
        point.

    Notes
    -----
    Cost: Dijkstra's algorithm within the extents.
    """
    above, below = np.zeros(len(mesh.vertices)), np.ones(len(mesh.vertices))
    for point, depth, extent in zip(points.tolist(), depths, extents, strict=True):
        start = int(np.argmin(np.abs(mesh.vertices - point)))
        ways = dijkstra(paths, directed=False, indices=[start], limit=extent)[0]
        part = np.clip((extent - ways) / ((1 - PLATEAU) * extent), 0.0, 1.0)
        weight = part * part * (3 - 2 * part)
        # w / (1 − w), beside the 1 of no depth at all: a single point contributes w times its
        # depth.
        pull = weight / np.maximum(1 - weight, 1e-9)
        above += pull * depth
        below += pull
    spread: Floats = above / below
    return spread


def find_distances(mesh: Mesh, start: complex, ends: Complexes) -> Floats:
    """Return the distances from a point of a shape to others (n,), inside the shape."""
    first, *others = (int(np.argmin(np.abs(mesh.vertices - each))) for each in (start, *ends))
    found: Floats = dijkstra(find_paths(mesh), directed=False, indices=[first])[0][others]
    return found


def sort_by_depth(mesh: Mesh, depths: Floats) -> Integers:
    """Return the triangles (m, 3) from back to front by the depths (v,) of their corners.

    Triangles of equal depth keep their order.
    """
    levels = np.rint(depths[mesh.triangles].mean(axis=1) / FINEST).astype(np.int64)
    return readonly(mesh.triangles[np.argsort(levels, kind="stable")])


def find_paths(mesh: Mesh) -> scipy.sparse.csr_array:
    """Return the lengths (v, v) of the edges, and of the straight paths across them.

    They run from triangle to triangle, so that a way along them is at most a few percent longer
    than the shortest one inside the shape.
    """
    near, far = np.concatenate([mesh.edges().astype(np.intp), _across(mesh)]).T
    lengths = np.abs(mesh.vertices[far] - mesh.vertices[near])
    count = len(mesh.vertices)
    return scipy.sparse.csr_array((lengths, (near, far)), shape=(count, count))


def _across(mesh: Mesh) -> Indices:
    """Return the vertices (n, 2) on both sides of an edge whose straight connection is inside."""
    _, _, counterparts = sides_of(mesh.triangles)
    corners = mesh.triangles.ravel().astype(np.intp)
    a, b = corners[counterparts[:, 0]], corners[following(counterparts[:, 0])]
    c, d = corners[preceding(counterparts.T)]
    # The line from c to d stays inside if the four corners are convex.
    seen = np.ones(len(a), dtype=np.bool_)
    for end, sign in ((a, 1.0), (b, -1.0)):
        seen &= sign * signed_areas(mesh.vertices, np.column_stack([c, d, end])) < 0
    return np.column_stack([c, d])[seen]
