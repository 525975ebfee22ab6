"""The strip between the boundary and a lattice inside it: constrained Delaunay triangulation."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from engine.arrays import Booleans, Complexes, Indices, ragged_indices
from engine.domain.meshing.half_edges import OUTLINE, HalfEdgeMesh, disjoint
from engine.geometry import as_xy, constrained_delaunay, loop_ends


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rings:
    """The loops of a boundary with the points that cut their edges into pieces.

    Parameters
    ----------
    points : complex128, shape (r,)
        First the vertices of all loops, then the cuts.
    order : intp, shape (r,)
        The points' indices in the order along the loops, one loop after the other.
    size : intp, shape (r,)
        For each entry of `order`, the number of points of its loop.
    """

    points: Complexes
    order: Indices
    size: Indices


def split_edges(loops: Sequence[Complexes], spacing: float) -> Rings:
    """Cut each edge of polygons into equal pieces about as long as the spacing."""
    starts = np.concatenate(loops)
    along = loop_ends(loops) - starts
    pieces = np.maximum(np.round(np.abs(along) / spacing), 1).astype(np.intp)
    edge, place = ragged_indices(pieces)
    points = starts[edge] + place / pieces[edge] * along[edge]
    # Vertices of the loops go first.
    rank = np.argsort(place > 0, kind="stable")
    sizes = np.add.reduceat(pieces, np.cumsum([0, *map(len, loops[:-1])]))
    return Rings(points=points[rank], order=np.argsort(rank), size=np.repeat(sizes, sizes))


def triangulate_strip(
    loops: Sequence[Complexes], rings: Rings, lattice: HalfEdgeMesh, loose: Indices
) -> Indices:
    """Return counter-clockwise triangles (m, 3) between the rings and a part of a lattice inside.

    Parameters
    ----------
    loops : sequence of complex128
        A simple polygon, counter-clockwise, and those of its holes, clockwise.
    rings : Rings
        Of these loops.
    lattice : HalfEdgeMesh
        Unit triangles, including all with an edge to the strip. Other edges without a neighbour are
        marked as `SEAM`. Its points begin with the rings', and no point of a loop is within the
        circumcircle of a triangle.
    loose : intp, shape (s,)
        Points of the lattice that no unit triangle uses.
    """
    mesh = HalfEdgeMesh(lattice.points, constrained_delaunay(loops[0], loops[1:]))
    _cut_border(mesh, rings)
    rim = np.flatnonzero(lattice.counterparts == OUTLINE)
    _insert_all(mesh, np.concatenate([np.unique(lattice.origins[rim]), loose]))
    return mesh.triangles[~_enclosed(mesh, *lattice.ends(rim))]


def _cut_border(mesh: HalfEdgeMesh, rings: Rings) -> None:
    """Split the border of a Delaunay mesh of the loops at all cuts of the rings."""
    position = np.argsort(rings.order)
    while True:
        border = np.flatnonzero(mesh.counterparts < 0)
        start, end = mesh.ends(border)
        place = position[start]
        steps = (position[end] - place) % rings.size[place]
        border, middle = border[steps > 1], (place + steps // 2)[steps > 1]
        if not len(border):
            return
        chosen = disjoint(border // 3, among=mesh.count)
        around = mesh.split_border(rings.order[middle[chosen]], border[chosen])
        mesh.restore_delaunay(around)


def _insert_all(mesh: HalfEdgeMesh, vertices: Indices) -> None:
    """Insert vertices into a constrained Delaunay mesh."""
    # In random order, successive vertices seldom claim the same triangle.
    mesh.waiting = np.random.default_rng(0).permutation(vertices)
    mesh.places = _locate(mesh, mesh.points[mesh.waiting])
    while len(mesh.waiting):
        inserted, suspects = mesh.insert_where_possible(mesh.waiting, mesh.places)
        mesh.waiting, mesh.places = mesh.waiting[~inserted], mesh.places[~inserted]
        mesh.restore_delaunay(suspects)


def _locate(mesh: HalfEdgeMesh, points: Complexes) -> Indices:
    """Return for each point a triangle that contains it."""
    corners = mesh.points[mesh.triangles]
    tree = shapely.STRtree(shapely.polygons(np.stack([corners.real, corners.imag], axis=-1)))
    found, triangle = tree.query(shapely.points(as_xy(points)), predicate="intersects")
    places = np.full(len(points), -1)
    places[found] = triangle
    return places


def _enclosed(mesh: HalfEdgeMesh, starts: Indices, ends: Indices) -> Booleans:
    """Mark the triangles enclosed by directed edges (r,) that have them on the left.

    A flood fill that begins on the left of the edges and does not cross them.
    """
    fence = starts * len(mesh.points) + ends
    start, end = mesh.ends(np.arange(len(mesh.origins)))
    left = np.isin(start * len(mesh.points) + end, fence)
    right = np.isin(end * len(mesh.points) + start, fence)
    open_to = np.flatnonzero((mesh.counterparts >= 0) & ~left & ~right)
    pairs = open_to // 3, mesh.counterparts[open_to] // 3
    graph = coo_array((np.ones(len(open_to)), pairs), shape=(mesh.count, mesh.count))
    _, part = connected_components(graph, directed=False)
    return np.isin(part, part[np.flatnonzero(left) // 3])
