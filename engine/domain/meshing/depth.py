"""What is in front: depths that spread from points of a shape, and triangles painted by them."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import dijkstra

from engine.arrays import Complexes, Floats, Indices, Integers, readonly
from engine.domain.meshing.half_edges import following, preceding
from engine.domain.meshing.mesh import Mesh, sides_of, signed_areas

# Of the extent; up to there the depth is the point's own. Two limbs that are both so near are as
# deep as each other, and keep the order that they have without depth.
PLATEAU = 0.5
# Of the range from 0 to 1. What differs less is equally deep.
FINEST = 1e-3


def spread_depth(
    mesh: Mesh, points: Complexes, depths: Sequence[float], extents: Sequence[float]
) -> Floats:
    """Spread the depths of some points over a shape, along it and never across a gap.

    Parameters
    ----------
    mesh : Mesh
        Of the shape at rest.
    points : complex128, shape (p,)
        In the shape; each is moved to the vertex next to it.
    depths : sequence of float
        Of each point, from −1, behind, to 1, in front.
    extents : sequence of float
        How far from each point its depth falls to 0, in the unit of the mesh.

    Returns
    -------
    float64, shape (v,)
        Where one point reaches, its depth times a weight that is 1 up to half its extent and falls
        smoothly to 0; where several reach, their mean, in which each point keeps its own.

    Notes
    -----
    Ways lead along edges and straight across them from triangle to triangle, so that they are at
    most a few percent longer than the shortest ones. Cost: Dijkstra's algorithm as far as the
    extents go.
    """
    above, below = np.zeros(len(mesh.vertices)), np.ones(len(mesh.vertices))
    graph = _ways(mesh)
    for point, depth, extent in zip(points.tolist(), depths, extents, strict=True):
        start = int(np.argmin(np.abs(mesh.vertices - point)))
        ways = dijkstra(graph, directed=False, indices=[start], limit=extent)[0]
        part = np.clip((extent - ways) / ((1 - PLATEAU) * extent), 0.0, 1.0)
        weight = part * part * (3 - 2 * part)
        # w / (1 − w), beside the 1 of no depth at all: alone, a point brings w times its depth.
        pull = weight / np.maximum(1 - weight, 1e-9)
        above += pull * depth
        below += pull
    spread: Floats = above / below
    return spread


def find_distances(mesh: Mesh, start: complex, ends: Complexes) -> Floats:
    """Return how far it is from a point of a shape to some others (n,) inside it, likewise."""
    first, *others = (int(np.argmin(np.abs(mesh.vertices - each))) for each in (start, *ends))
    found: Floats = dijkstra(_ways(mesh), directed=False, indices=[first])[0][others]
    return found


def sort_by_depth(mesh: Mesh, depths: Floats) -> Integers:
    """Return the triangles (m, 3) from back to front by the depths (v,) of their corners.

    Equally deep ones keep their order.
    """
    levels = np.rint(depths[mesh.triangles].mean(axis=1) / FINEST).astype(np.int64)
    return readonly(mesh.triangles[np.argsort(levels, kind="stable")])


def _ways(mesh: Mesh) -> scipy.sparse.csr_array:
    """Return the lengths of the edges, and of the straight ways across them."""
    near, far = np.concatenate([mesh.edges().astype(np.intp), _across(mesh)]).T
    lengths = np.abs(mesh.vertices[far] - mesh.vertices[near])
    count = len(mesh.vertices)
    return scipy.sparse.csr_array((lengths, (near, far)), shape=(count, count))


def _across(mesh: Mesh) -> Indices:
    """Return the vertices (n, 2) that face each other across an edge and see each other there."""
    _, _, twins = sides_of(mesh.triangles)
    corners = mesh.triangles.ravel().astype(np.intp)
    a, b = corners[twins[:, 0]], corners[following(twins[:, 0])]
    c, d = corners[preceding(twins.T)]
    # The way from c to d stays inside if the four corners are convex.
    seen = np.ones(len(a), dtype=np.bool_)
    for end, sign in ((a, 1.0), (b, -1.0)):
        seen &= sign * signed_areas(mesh.vertices, np.column_stack([c, d, end])) < 0
    return np.column_stack([c, d])[seen]
