"""Chew's second algorithm: insert points until no triangle has a needlessly small angle.

Source: L. P. Chew, "Guaranteed-quality mesh generation for curved surfaces" (1993); off-centres
after A. Üngör, "Off-centers: a new type of Steiner points" (2004). Unlike Chew's, a point that sees
an outline edge at over 90° is never inserted; the edge is split instead (J. Ruppert, 1995).
"""

import numpy as np

from engine.arrays import Booleans, Complexes, Indices
from engine.domain.meshing.half_edges import OUTLINE, HalfEdgeMesh, disjoint, following, preceding
from engine.domain.meshing.mesh import smallest_angles

MOST_ROUNDS = 100  # a bad outline takes about 40
# Least length of the outline's edges, over its size; edges are never split below it.
SHORTEST_EDGE = 1e-6


def refine_mesh(mesh: HalfEdgeMesh, smallest: float) -> None:
    """Insert points into a constrained Delaunay triangulation until all angles are large enough.

    Only angles of the outline itself remain smaller. The triangulation stays constrained Delaunay.

    Parameters
    ----------
    mesh : HalfEdgeMesh
        Of size 1; changed in place.
    smallest : float
        Wanted angle in degrees; up to about 28 is reached on all outlines.
    """
    for _ in range(MOST_ROUNDS):
        bad = _triangles_to_improve(mesh, smallest)
        if not len(bad):
            break
        centres = _off_centres(mesh, bad, smallest)
        triangles, exits = mesh.walk(bad, centres)
        reached = exits < 0
        hidden = exits[~reached & (mesh.counterparts[exits] == OUTLINE)]
        encroached = _encroached(mesh, triangles[reached], centres[reached])
        reached[reached] = encroached < 0
        split = np.unique(np.concatenate([hidden, encroached[encroached >= 0]]))
        touched = _split_outline(mesh, split)
        suspects = _insert(mesh, centres[reached], triangles[reached], touched)
        if not len(touched) + len(suspects):
            break
        mesh.restore_delaunay(np.concatenate([touched, suspects]))


def _triangles_to_improve(mesh: HalfEdgeMesh, smallest: float) -> Indices:
    """Return the triangles with an angle below `smallest`, the worst one last."""
    angles = smallest_angles(mesh.points, mesh.triangles)
    bad = np.flatnonzero(angles < smallest)
    bad = bad[~_enforced(mesh, bad)]
    return bad[np.argsort(-angles[bad], kind="stable")]


def _shortest_edges(mesh: HalfEdgeMesh, triangles: Indices) -> Indices:
    """Return the half-edge opposite to the smallest angle of each triangle."""
    corners = mesh.points[mesh.triangles[triangles]]
    shortest: Indices = np.argmin(np.abs(np.roll(corners, -1, axis=1) - corners), axis=1)
    return 3 * triangles + shortest


def _enforced(mesh: HalfEdgeMesh, triangles: Indices) -> Booleans:
    """Mark the triangles whose smallest angle lies between two edges of the outline."""
    opposite = _shortest_edges(mesh, triangles)
    sides = mesh.counterparts[[following(opposite), preceding(opposite)]]
    return np.asarray((sides == OUTLINE).all(axis=0))


def _off_centres(mesh: HalfEdgeMesh, triangles: Indices, smallest: float) -> Complexes:
    """Return a point to insert against each triangle's smallest angle.

    It is the circumcentre, or the nearest point on the way there from the shortest edge that makes
    a good enough triangle with this edge: that saves points.
    """
    pq = _shortest_edges(mesh, triangles)
    p, q = mesh.end_points(pq)
    v = mesh.points[mesh.origins[preceding(pq)]]
    # The angle at v over p-q is half of that at the centre: height = |pq|/2 · cot(angle).
    at_v = (q - v) * (p - v).conj()
    to_circumcentre = 0.5 * at_v.real / at_v.imag
    to_off_centre = 0.475 / np.tan(np.radians(smallest) / 2)
    height = np.minimum(to_circumcentre, to_off_centre)
    return np.asarray((p + q) / 2 + 1j * height * (q - p))


def _encroached(mesh: HalfEdgeMesh, triangles: Indices, points: Complexes) -> Indices:
    """Return the outline edge of each triangle that its point sees at over 90°, or -1."""
    half_edges = 3 * triangles[:, None] + np.arange(3)
    a, b = mesh.end_points(half_edges)
    cosine = ((a - points[:, None]).conj() * (b - points[:, None])).real
    cosine[mesh.counterparts[half_edges] != OUTLINE] = np.inf
    widest = np.argmin(cosine / np.abs(b - a) ** 2, axis=1)
    row = np.arange(len(widest))
    return np.where(cosine[row, widest] < 0, half_edges[row, widest], -1)


def _split_outline(mesh: HalfEdgeMesh, half_edges: Indices) -> Indices:
    """Split outline edges, one a triangle, in the middle; return the half-edges around."""
    a, b = mesh.end_points(half_edges)
    half_edges = half_edges[np.abs(b - a) > SHORTEST_EDGE]
    half_edges = half_edges[disjoint(half_edges // 3, among=mesh.count)]
    a, b = mesh.end_points(half_edges)
    return mesh.split_border(mesh.add_points((a + b) / 2), half_edges)


def _insert(mesh: HalfEdgeMesh, points: Complexes, triangles: Indices, touched: Indices) -> Indices:
    """Insert the points that are far enough from each other and from the touched triangles.

    Returns the half-edges that may not be Delaunay any more.
    """
    free = ~np.isin(triangles, touched // 3)
    points, triangles = points[free], triangles[free]
    around = mesh.counterparts[3 * triangles[:, None] + np.arange(3)] // 3
    apart = disjoint(triangles, *around.T, among=mesh.count)
    vertices = mesh.add_points(points[apart])
    _, suspects = mesh.insert_where_possible(vertices, triangles[apart])
    return suspects
