"""Laplacian smoothing of a triangulation that never makes a poor triangle poorer."""

import numpy as np

from engine.arrays import Complexes, Indices
from engine.half_edges import HalfEdgeMesh
from engine.mesh import smallest_angles

GOOD_ANGLE = 35.0
"""Degrees: a triangle may lose quality as long as its smallest angle stays above this."""


def smooth(mesh: HalfEdgeMesh, sweeps: int) -> None:
    """Move vertices off the border to the middle of their neighbours and flip edges to match.

    Parameters
    ----------
    mesh : HalfEdgeMesh
        Constrained Delaunay; changed in place and left so.
    sweeps : int
        How often every vertex moves.
    """
    half_edges = np.arange(len(mesh.origins))
    movable = np.zeros(len(mesh.points), dtype=np.bool_)
    movable[mesh.origins] = True
    movable[mesh.origins[mesh.twins < 0]] = False
    for _ in range(sweeps):
        target = np.where(movable, _middle_of_neighbours(mesh, half_edges), mesh.points)
        mesh.points = _safe_move(mesh, target)
        mesh.restore_delaunay(half_edges)


def _middle_of_neighbours(mesh: HalfEdgeMesh, half_edges: Indices) -> Complexes:
    """Return the mean of the neighbours (v,) of each vertex, right for those off the border."""
    start, end = mesh.ends(half_edges)
    size = len(mesh.points)
    x = np.bincount(start, mesh.points.real[end], size)
    y = np.bincount(start, mesh.points.imag[end], size)
    return np.asarray((x + 1j * y) / np.maximum(np.bincount(start, minlength=size), 1))


def _safe_move(mesh: HalfEdgeMesh, target: Complexes) -> Complexes:
    """Return the target positions, but the present ones where moving would spoil a triangle."""
    enough = np.minimum(smallest_angles(mesh.points, mesh.triangles), GOOD_ANGLE)
    points = target
    while True:
        spoilt = smallest_angles(points, mesh.triangles) < enough
        if not spoilt.any():
            return points
        # A triangle is only spoilt if one of its corners moved: each round leaves fewer that do.
        back = mesh.triangles[spoilt].ravel()
        points = points.copy()
        points[back] = mesh.points[back]
