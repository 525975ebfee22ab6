"""The order of painting triangles, for poses in which a shape overlaps itself."""

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import breadth_first_order, connected_components, dijkstra
from scipy.spatial import cKDTree

from engine.arrays import Booleans, Indices, Integers, freeze
from engine.domain.meshing.branches import rank_branches
from engine.domain.meshing.mesh import Mesh, sides_of
from engine.geometry import as_xy


def order_branches_on_top(mesh: Mesh, centre: complex) -> Mesh:
    """Return the mesh with its triangles limb by limb, each outwards from a point of the shape.

    A limb then covers its parent. Of two limbs always the same one covers the other, wherever they
    cross. A curled limb covers itself by its outer part. The order does not depend on the pose, so
    that it is steady while the shape moves.

    Notes
    -----
    Paths start along the edges from the vertex next to `centre`. Around a hole they meet again. The
    part around the hole is first treated as one limb. Then the sides of the line where paths meet
    are separated within it. Cost: that of Dijkstra's algorithm and of sorting, O(v log v).
    """
    edges = mesh.edges()
    lengths = np.abs(mesh.vertices[edges[:, 1]] - mesh.vertices[edges[:, 0]])
    count = len(mesh.vertices)
    graph = scipy.sparse.csr_array((lengths, (edges[:, 0], edges[:, 1])), shape=(count, count))
    root = int(np.argmin(np.abs(mesh.vertices - centre)))
    found = dijkstra(graph, directed=False, indices=[root], return_predecessors=True)
    ways, previous = found[0][0], found[1][0]
    areas = np.bincount(mesh.triangles.ravel(), np.repeat(mesh.areas(), 3), count) / 3
    ranks = rank_branches(mesh.vertices, edges, areas, ways)
    if len(mesh.triangles) + count - len(edges) < 1:  # Euler: there are holes
        whole = ~_where_ways_meet(mesh, edges, previous)
        whole &= ranks[edges[:, 0]] == ranks[edges[:, 1]]
        sides = rank_branches(mesh.vertices, edges[whole], areas, ways)
        ranks = ranks * (sides.max() + 1) + sides
    outwards = ways[mesh.triangles].sum(axis=1)
    return _reordered(mesh, np.lexsort((outwards, ranks[mesh.triangles].max(axis=1))))


def copy_draw_order(mesh: Mesh, other: Mesh) -> Mesh:
    """Return a mesh with its triangles in the order of another mesh of the same shape."""
    here, there = (as_xy(each.vertices[each.triangles].mean(axis=1)) for each in (mesh, other))
    _, nearest = cKDTree(there).query(here)
    return _reordered(mesh, np.argsort(nearest, kind="stable"))


def _reordered(mesh: Mesh, order: Indices) -> Mesh:
    return Mesh(vertices=mesh.vertices, triangles=freeze(mesh.triangles[order]))


def _where_ways_meet(mesh: Mesh, edges: Integers, previous: Integers) -> Booleans:
    """Mark the `Mesh.edges` that cross a line from a hole to the border where shortest paths meet.

    The edges on no shortest path join the triangles, the holes and the outside to another tree
    (Eppstein 2003). Its branches to the holes are the lines. `previous` (v,) is the vertex before
    each vertex on its shortest path.
    """
    faces, outside = _faces_beside(mesh, edges)
    near, far = edges.T
    crossed = np.flatnonzero((previous[near] != far) & (previous[far] != near))
    count = faces.max() + 1
    # Edges count from 1 here, because a sparse array keeps no zeros.
    tree = scipy.sparse.csr_array((crossed + 1, faces[crossed].T), shape=(count, count))
    _, towards = breadth_first_order(tree, outside, directed=False)
    meeting = np.zeros(len(edges), dtype=np.bool_)
    for loop in range(len(mesh.triangles), count):
        face = loop
        while face != outside:
            following = towards[face]
            meeting[max(tree[face, following], tree[following, face]) - 1] = True
            face = following
    return meeting


def _faces_beside(mesh: Mesh, edges: Integers) -> tuple[Indices, int]:
    """Return the faces on the two sides of each edge, (e, 2), and the face of the outside.

    Faces are the triangles, by their indices, and after them the loops of the border.
    """
    count = len(mesh.vertices)
    _, numbers, _ = sides_of(mesh.triangles)
    forward = (mesh.triangles < np.roll(mesh.triangles, -1, axis=1)).astype(np.intp)
    faces = np.full((len(edges), 2), -1)
    faces[numbers, forward] = np.arange(len(mesh.triangles))[:, None]
    border = np.flatnonzero((faces < 0).any(axis=1))
    ends = edges[border]
    loops = scipy.sparse.coo_array((np.ones(len(ends)), ends.T), shape=(count, count))
    _, parts = connected_components(loops, directed=False)
    _, loop = np.unique(parts[ends[:, 0]], return_inverse=True)
    loop += len(mesh.triangles)
    faces[border] = np.where(faces[border] < 0, loop[:, np.newaxis], faces[border])
    return faces, int(loop[np.argmin(mesh.vertices[ends[:, 0]].real)])
