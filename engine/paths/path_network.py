"""Graphs inside a region with paths from the anchor to every point (Section 7).

The vertices of a mesh are reached along its edges. Scattered points have no edges. For them the
region is cut into triangles, and paths lead through the midpoints of the triangles' common edges. A
triangle is convex, so each leg of such a path stays inside even if the domain is narrow.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import shapely
from scipy.sparse import csr_array

from engine.arrays import Booleans, Complexes, Indices, Integers
from engine.domain.meshing.mesh import Mesh, sides_of
from engine.errors import EngineError
from engine.geometry import (
    as_xy,
    constrained_delaunay,
    diameter,
)
from engine.paths.loops import Loops
from engine.paths.region import leave_region
from engine.paths.spanning_tree import breadth_first_parents, shortest_parents

CELL = 1 / 50  # longest edge of the triangles between scattered points, relative to the diameter
NEIGHBOURS = 64  # nodes that are tried for a straight path to the anchor, or to a loop
TRIES = 32  # points of a loop around a hole from which the search for nodes starts

# Subdivision of a triangle with corners 0, 1, 2 if the sides 01, 12, 20 (bits 1, 2, 4 of the index)
# have the midpoints 3, 4, 5.
PIECES: tuple[list[list[int]], ...] = (
    [[0, 1, 2]],
    [[0, 3, 2], [3, 1, 2]],
    [[1, 4, 0], [4, 2, 0]],
    [[3, 1, 4], [0, 3, 4], [0, 4, 2]],
    [[2, 5, 1], [5, 0, 1]],
    [[5, 0, 3], [2, 5, 3], [2, 3, 1]],
    [[4, 2, 5], [1, 4, 5], [1, 5, 0]],
    [[0, 3, 5], [3, 1, 4], [4, 2, 5], [3, 4, 5]],
)
MESH_POINTS = (
    "The triangles name points from {smallest} to {largest}, but there are only points 0 to {last}."
)
EDGE_LEAVES = (
    "The triangles' edge from point {first} to point {second} leaves the outline; give triangles "
    "of the inside only, or none."
)
ANCHOR_UNREACHED = (
    "No point of the mesh has a straight path to the anchor {anchor:.6g}; choose an anchor "
    "inside the triangles."
)


def _none() -> Indices:
    return np.empty(0, dtype=np.intp)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Network:
    """A tree of straight legs inside the domain; node 0 is the anchor.

    Attributes
    ----------
    nodes : complex128, shape (s,)
    parents : intp, shape (s,)
        Parent of each node; −1 for nodes outside the tree.
    places : intp, shape (m,)
        The node of each point.
    around : intp, shape (c,)
        Nodes of loops around holes.
    beside : intp, shape (v,)
        Nodes of points where only the integrand is evaluated.
    """

    nodes: Complexes
    parents: Indices
    places: Indices
    around: Indices = field(default_factory=_none)
    beside: Indices = field(default_factory=_none)

    def lead_to(self, ends: Indices) -> Booleans:
        """Return which nodes (s,) are ends or lie on the paths from the anchor to the ends."""
        return _ways(self.parents, ends)


def mesh_network(
    outline: Complexes,
    vertices: Complexes,
    triangles: Integers,
    anchor: Complexes,
    *,
    holes: Sequence[Complexes] = (),
) -> Network:
    """Join the anchor (1,) to the vertices (m,) of a mesh along the mesh's edges.

    A path passes a hole on the side with fewer edges; no path crosses a hole.

    Raises
    ------
    EngineError
        If a triangle index is invalid, an edge leaves the outline, or a vertex is not connected to
        the rest by triangles. Also if the anchor has no straight path to a vertex near it.
    """
    if not len(triangles):
        raise EngineError(
            "There are no triangles. Leave the triangles out, and the engine finds its own paths."
        )
    if triangles.min(initial=0) < 0 or triangles.max(initial=0) >= len(vertices):
        raise EngineError(
            MESH_POINTS, smallest=triangles.min(), largest=triangles.max(), last=len(vertices) - 1
        )
    loops = (outline, *holes)
    along, against = _directed(triangles, len(vertices))
    # If all triangles are counter-clockwise, the boundary of their union consists of edges without
    # an opposite edge. If these edges are inside the outline, so are all triangles.
    areas = Mesh(vertices=vertices, triangles=triangles).areas()
    is_simple = not holes and areas.min(initial=1.0) > 0
    first, second = (along - against if is_simple else along + against).nonzero()
    ends = np.column_stack([first, second])[first < second]
    crossing = leave_region(loops, vertices[ends[:, 0]], vertices[ends[:, 1]])
    if crossing.any():
        first, second = ends[np.flatnonzero(crossing)[0]]
        raise EngineError(EDGE_LEAVES, first=first, second=second)
    nearest = np.argsort(np.abs(vertices - anchor), kind="stable")[:NEIGHBOURS]
    seen = nearest[~leave_region(loops, np.repeat(anchor, len(nearest)), vertices[nearest])]
    if not len(seen):
        raise EngineError(ANCHOR_UNREACHED, anchor=anchor[0])
    reached = shortest_parents(along + against, int(seen[0]))
    if np.any(reached < 0):
        raise EngineError(
            "No triangles connect point {point} to the anchor. Leave the triangles out, and the "
            "engine finds its own paths.",
            point=np.flatnonzero(reached < 0)[0],
        )
    nodes, parents = np.concatenate([anchor, vertices]), np.concatenate([[0], reached + 1])
    parents[seen[0] + 1] = 0
    return Network(nodes=nodes, parents=parents, places=np.arange(1, len(nodes)))


def scattered_network(
    outline: Complexes,
    points: Complexes,
    anchor: Complexes,
    *,
    holes: Sequence[Complexes] = (),
) -> Network:
    """Join the anchor (1,) to scattered points (m,) of a closed region."""
    corners, triangles = _refine(
        np.concatenate([outline, *holes]),
        constrained_delaunay(outline, holes),
        CELL * diameter(outline),
    )
    portals, sides = _portals(corners, triangles)
    ends = np.concatenate([anchor, points])
    cells = shapely.STRtree(shapely.polygons(as_xy(corners)[triangles]))
    # A point on the outline may fall outside by rounding; it belongs to the nearest triangle.
    home = sides[cells.query_nearest(shapely.points(as_xy(ends)), all_matches=False)[1]]
    legs = [sides[:, [k, (k + 1) % 3]] for k in range(3)]
    legs = [leg[(leg >= 0).all(axis=1)] + len(ends) for leg in legs]
    for own in home.T:
        inner = np.flatnonzero(own >= 0)
        legs.append(np.column_stack([inner, own[inner] + len(ends)]))
    beside = np.flatnonzero((home[1:] == home[0]).all(axis=1)) + 1
    legs.append(np.column_stack([np.zeros_like(beside), beside]))
    nodes = np.concatenate([ends, portals])
    parents = breadth_first_parents(len(nodes), np.concatenate(legs), 0)
    passed = _ways(parents, np.arange(len(ends)))
    parents = np.where(passed, parents, -1)
    return Network(nodes=nodes, parents=parents, places=np.arange(1, len(ends)))


def chain_starts(loops: Sequence[Complexes], points: Complexes) -> Booleans:
    """Return which points (v,) have no straight path from the previous point."""
    starts = leave_region(loops, np.roll(points, 1), points)
    starts[:1] = True
    return starts


def with_chains(network: Network, points: Complexes, starts: Booleans) -> Network:
    """Return a network extended along chains of points (v,).

    The last places of the given network are the starts of the chains.
    """
    first, count = len(network.nodes), int(np.count_nonzero(starts))
    places, heads = np.split(network.places, [len(network.places) - count])
    beside = np.empty(len(points), dtype=np.intp)
    beside[starts], beside[~starts] = heads, first + np.arange(len(points) - count)
    return replace(
        network,
        nodes=np.concatenate([network.nodes, points[~starts]]),
        parents=np.concatenate([network.parents, np.roll(beside, 1)[~starts]]),
        places=places,
        beside=beside,
    )


def with_loops(
    network: Network, outline: Complexes, holes: Sequence[Complexes], loops: Loops
) -> Network:
    """Return a network extended around each hole.

    Raises
    ------
    EngineError
        If no node near a loop has a straight path to it.
    """
    reached = np.flatnonzero(network.parents >= 0)
    parents, ends = [network.parents], [*loops.starts[1:], len(loops.nodes)]
    first = len(network.nodes)
    for number, (start, end) in enumerate(zip(loops.starts, ends, strict=True)):
        along = loops.nodes[start:end]
        for begin in range(0, len(along), max(1, len(along) // TRIES)):
            distance = np.abs(network.nodes[reached] - along[begin])
            nearest = reached[np.argsort(distance, kind="stable")[:NEIGHBOURS]]
            from_loop = np.repeat(along[begin], len(nearest))
            seen = nearest[~leave_region((outline, *holes), from_loop, network.nodes[nearest])]
            if len(seen):
                break
        else:
            raise EngineError(
                "No point of the mesh near hole {number} has a straight path to the hole; give "
                "more points around the hole.",
                number=number,
            )
        order = first + np.roll(np.arange(len(along)), -begin)
        own = np.empty(len(along), dtype=np.intp)
        own[order - first] = np.concatenate([seen[:1], order[:-1]])
        parents.append(own)
        first += len(along)
    around = len(network.nodes) + np.arange(len(loops.nodes))
    nodes = np.concatenate([network.nodes, loops.nodes])
    return replace(network, nodes=nodes, parents=np.concatenate(parents), around=around)


def _directed(triangles: Integers, count: int) -> tuple[csr_array, csr_array]:
    """Return how often triangles lead from each point to each other (n, n), and its transpose."""
    starts, ends = triangles.ravel(), triangles[:, [1, 2, 0]].ravel()
    ones = np.ones(len(starts), dtype=np.int32)
    along = csr_array((ones, (starts, ends)), shape=(count, count))
    return along, along.T.tocsr()


def _refine(corners: Complexes, triangles: Indices, longest: float) -> tuple[Complexes, Indices]:
    """Halve every side longer than `longest`, in both of its triangles, until none is left."""
    while True:
        sides, numbers, _ = sides_of(triangles)
        long = np.abs(corners[sides[:, 0]] - corners[sides[:, 1]]) > longest
        if not long.any():
            return corners, triangles
        middle = len(corners) + np.cumsum(long) - 1
        corners = np.concatenate([corners, corners[sides[long]].mean(axis=1)])
        local = np.column_stack([triangles, middle[numbers]])
        pattern = long[numbers] @ np.array([1, 2, 4])
        triangles = np.concatenate(
            [local[pattern == k][:, pieces].reshape(-1, 3) for k, pieces in enumerate(PIECES)]
        )


def _portals(corners: Complexes, triangles: Indices) -> tuple[Complexes, Indices]:
    """Return the midpoints of sides with two triangles, and those of each triangle, (t, 3).

    The index is −1 for a side on the polygon.
    """
    sides, numbers, _ = sides_of(triangles)
    shared = np.bincount(numbers.ravel(), minlength=len(sides)) == 2
    portal = np.where(shared, np.cumsum(shared) - 1, -1)
    return corners[sides[shared]].mean(axis=1), portal[numbers]


def _ways(parents: Indices, ends: Indices) -> Booleans:
    """Return which nodes (s,) are ends, or on the path from the anchor to one."""
    passed = np.zeros(len(parents), dtype=np.bool_)
    new = ends
    while len(new):
        passed[new] = True
        new = np.unique(parents[new])
        new = new[~passed[new]]
    return passed
