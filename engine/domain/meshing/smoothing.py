"""Smoothing of a triangulation: every vertex moves to make its triangles equilateral."""

import numpy as np

from engine.arrays import Complexes, Indices
from engine.domain.meshing.half_edges import OUTLINE, HalfEdgeMesh, following, preceding
from engine.domain.meshing.mesh import smallest_angles

GOOD_ANGLE = 30.0  # degrees: larger angles may shrink


def smooth_mesh(mesh: HalfEdgeMesh, corners: int, sweeps: int) -> None:
    """Move vertices, those on the outline along it, and flip edges to match.

    Parameters
    ----------
    mesh : HalfEdgeMesh
        Constrained Delaunay; changed in place and left so.
    corners : int
        Number of the outline's own vertices, which come first and stay, as the seam does.
    sweeps : int
        Number of moves of every vertex.
    """
    border = np.flatnonzero(mesh.counterparts < 0)
    fixed = np.ones(len(mesh.points), dtype=np.bool_)
    fixed[mesh.origins] = False
    fixed[mesh.origins[border]] = True
    before, sliding, after = _cuts(mesh, corners)
    for _ in range(sweeps):
        best = _best_places(mesh)
        target = np.where(fixed, mesh.points, best)
        start, end = mesh.points[before], mesh.points[after]
        target[sliding] = _project(best[sliding], start, end)
        mesh.points = _safe_move(mesh, target)
        mesh.restore_delaunay(np.arange(len(mesh.origins)))


def _cuts(mesh: HalfEdgeMesh, corners: int) -> tuple[Indices, Indices, Indices]:
    """Return the vertices that cut an edge of the outline, with those before and after them."""
    start, end = mesh.ends(np.flatnonzero(mesh.counterparts == OUTLINE))
    before = np.empty(len(mesh.points), dtype=np.intp)
    before[end] = start
    cut = start >= corners
    return before[start[cut]], start[cut], end[cut]


def _best_places(mesh: HalfEdgeMesh) -> Complexes:
    """Return for each vertex (v,) the mean of the places that make its triangles equilateral.

    Each place counts by the inverse length of the edge opposite to the vertex, which keeps small
    triangles small. (With equal weights an inner vertex would move to the mean of its neighbours.)
    """
    corner = np.arange(len(mesh.origins))
    p, q = (mesh.points[mesh.origins[near(corner)]] for near in (following, preceding))
    weight = 1 / np.abs(q - p)
    apex = weight * ((p + q) / 2 + 1j * np.sqrt(0.75) * (q - p))
    size = len(mesh.points)
    total = np.bincount(mesh.origins, weight, size)
    x = np.bincount(mesh.origins, apex.real, size)
    y = np.bincount(mesh.origins, apex.imag, size)
    return np.asarray((x + 1j * y) / np.where(total > 0, total, 1.0))


def _project(points: Complexes, starts: Complexes, ends: Complexes) -> Complexes:
    """Return the orthogonal projections of points on the lines from `starts` to `ends`."""
    direction = (ends - starts) / np.abs(ends - starts)
    return np.asarray(starts + ((points - starts) * direction.conj()).real * direction)


def _safe_move(mesh: HalfEdgeMesh, target: Complexes) -> Complexes:
    """Return the target positions, except where a move would spoil a triangle."""
    enough = np.minimum(smallest_angles(mesh.points, mesh.triangles), GOOD_ANGLE)
    points = target
    while True:
        spoilt = smallest_angles(points, mesh.triangles) < enough
        if not spoilt.any():
            return points
        # Only a moved corner can spoil a triangle: each round leaves fewer moved corners.
        back = mesh.triangles[spoilt].ravel()
        points[back] = mesh.points[back]
