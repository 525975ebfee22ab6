"""Mesh decimation: fewer triangles for exported meshes, or for frames that differ by 0.05 px."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np
from scipy.spatial import Delaunay

from app.document import Document, Layer
from engine.arrays import Booleans, Complexes, Indices, Integers, Singles
from engine.domain import MeshedDomain
from engine.domain.meshing.draw_order import copy_draw_order
from engine.domain.meshing.mesh import Mesh, border_edges
from engine.domain.meshing.triangulation import triangulate
from engine.geometry import as_xy

TOLERANCE: Final = 0.05  # pixels from a vertex to its drawn place, at most
# The target of a refinement, as a share of the tolerance. The in-betweens then seldom need more
# vertices.
_AIM: Final = 0.7
_SPACING: Final = 10.0  # pixels between vertices if nothing bends
_WORTH: Final = 0.5  # share of kept vertices above which all triangles are drawn
# Random shift, as a share of the spacing. Lattice points lie on common circles, which make Qhull
# slow.
_SHAKE: Final = 1e-5
_FLAT: Final = 1e-8  # of the spacing's square: slivers along a straight edge


class _ReducedMesh(NamedTuple):
    """Triangles between some of a mesh's vertices, and the places of the others in them.

    Parameters
    ----------
    triangles : int32, shape (k, 3)
        They cover the convex hull.
    dropped : int64, shape (d,)
        Vertices without a triangle.
    homes : int32, shape (d,)
        The triangles around the dropped vertices at rest.
    weights : float32, shape (3, d)
        Barycentric, at rest.
    """

    triangles: Integers
    dropped: Indices
    homes: Integers
    weights: Singles

    def distances(self, positions: Complexes) -> Singles:
        """Return the distance (d,) from each dropped vertex to its interpolated place."""
        places = positions.astype(np.complex64)
        off = -places[self.dropped]
        for corner, weight in zip(self.triangles[self.homes].T, self.weights, strict=True):
            off += weight * places[corner]
        distances: Singles = np.abs(off)
        return distances


class MeshDecimator:
    """Finds fewer triangles of a mesh that draw the same picture in every requested pose.

    In software OpenGL a triangle of a few pixels costs as much as one of many. Where a map bends
    little, a few vertices determine all others. They and the whole border are triangulated
    (Delaunay). Where a pose bends more, vertices are added until each vertex is drawn within the
    tolerance.

    `scale` is in pixels of the frame per unit of the plane.
    """

    def __init__(self, domain: MeshedDomain, scale: float) -> None:
        self._domain = domain
        self._tolerance = TOLERANCE / scale
        self._spacing = _SPACING / scale
        # Edge length of an equilateral triangle of the mean area.
        self._edge = float(np.sqrt(4 / np.sqrt(3) * domain.mesh.areas().mean()))
        self._border = border_edges(domain.mesh.triangles)
        self._kept: Booleans = np.zeros(len(domain.mesh.vertices), dtype=np.bool_)
        self._sheet: _ReducedMesh | None = None
        self._fewer: Mesh | None = None
        self._ordered: tuple[Integers, Integers] | None = None

    def prepare(self, poses: Sequence[Complexes]) -> None:
        """Find triangles that draw these poses, each (v,), and most likely the in-betweens.

        For 100,000 triangles this takes a second if they bend much, otherwise a quarter of it.
        """
        self._kept = _one_in_each_square(self._domain.mesh.vertices, self._spacing)
        self._kept[self._border] = True
        self._triangulate()
        self._refine(poses)

    def triangles(self, positions: Complexes, painted: Integers) -> Integers:
        """Return the triangles to draw, (k, 3), from back to front.

        `positions` are the posed vertices (v,). `painted` are the triangles (m, 3) of the mesh from
        back to front. They are returned if no decimation pays.
        """
        sheet = self._sheet
        if sheet is not None and not (sheet.distances(positions) <= self._tolerance).all():
            self._refine([positions])
        if self._fewer is None:
            return painted
        if self._ordered is None or self._ordered[0] is not painted:
            everything = Mesh(vertices=self._fewer.vertices, triangles=painted)
            self._ordered = painted, copy_draw_order(self._fewer, everything).triangles
        return self._ordered[1]

    def _refine(self, poses: Sequence[Complexes]) -> None:
        """Keep more vertices until all distances are within the target."""
        is_first = True
        while self._sheet is not None:
            off = np.max([self._sheet.distances(positions) for positions in poses], axis=0)
            excess = off / (_AIM * self._tolerance)
            # The distance is NaN in a triangle too flat for barycentric weights.
            if (excess <= 1).all():
                break
            self._keep_more(self._sheet, excess, is_graded=is_first)
            self._triangulate()
            is_first = False
        self._fewer = None if self._sheet is None else self._inside(self._sheet)
        self._ordered = None

    def _keep_more(self, sheet: _ReducedMesh, excess: Singles, *, is_graded: bool) -> None:
        """Keep dropped vertices by their `excess` (d,), their distance as a multiple of the target.

        Graded, it keeps one vertex in each square. The square's side follows from the excess: the
        error of linear interpolation falls with the square of the spacing. Otherwise it keeps all
        vertices in failing triangles.
        """
        fails = ~(excess <= 1)
        if not is_graded:
            self._kept[sheet.dropped[np.isin(sheet.homes, sheet.homes[fails])]] = True
            return
        side = self._spacing / 2
        while side >= 1.5 * self._edge:
            is_enough = fails & (excess <= (self._spacing / side) ** 2)
            found = sheet.dropped[is_enough]
            places = self._domain.mesh.vertices[found]
            self._kept[found[_one_in_each_square(places, side)]] = True
            fails &= ~is_enough
            side /= 2
        self._kept[sheet.dropped[fails]] = True

    def _triangulate(self) -> None:
        """Triangulate the kept vertices, unless they are too many."""
        vertices = self._domain.mesh.vertices
        kept, dropped = np.flatnonzero(self._kept), np.flatnonzero(~self._kept)
        if len(kept) > _WORTH * len(vertices):
            self._sheet = None
            return
        shaken = as_xy(vertices)
        shake = _SHAKE * self._spacing
        shaken = shaken + np.random.default_rng(0).uniform(-shake, shake, shaken.shape)
        found = Delaunay(shaken[kept])
        homes = found.find_simplex(shaken[dropped])
        to_weights = found.transform[homes]
        weights = np.einsum("nij,nj->in", to_weights[:, :2], shaken[dropped] - to_weights[:, 2])
        self._sheet = _ReducedMesh(
            triangles=kept[found.simplices].astype(np.int32),
            dropped=dropped,
            homes=homes,
            weights=np.vstack([weights, 1 - weights.sum(axis=0)]).astype(np.float32),
        )

    def _inside(self, sheet: _ReducedMesh) -> Mesh | None:
        """Return the part of a sheet in the domain; None if its border is not the domain's."""
        vertices = self._domain.mesh.vertices
        areas = Mesh(vertices=vertices, triangles=sheet.triangles).areas()
        inside = np.abs(areas) > _FLAT * self._spacing**2
        inside &= self._domain.contains(vertices[sheet.triangles].mean(axis=1))
        triangles = np.where(areas[:, np.newaxis] < 0, sheet.triangles[:, ::-1], sheet.triangles)
        # Across a narrow gap, the triangulation may replace border edges by shorter ones.
        is_whole = np.array_equal(border_edges(triangles[inside]), self._border)
        return Mesh(vertices=vertices, triangles=triangles[inside]) if is_whole else None


def _one_in_each_square(points: Complexes, side: float) -> Booleans:
    """Mark the point (of n) nearest to the middle in each square of a grid."""
    columns, rows = np.floor(points.real / side), np.floor(points.imag / side)
    away = np.abs(points / side - (columns + 0.5) - 1j * (rows + 0.5))
    order = np.lexsort((away, columns, rows))
    is_first = np.diff(columns[order], prepend=np.nan) != 0
    is_first |= np.diff(rows[order], prepend=np.nan) != 0
    marked: Booleans = np.zeros(len(points), dtype=np.bool_)
    marked[order[is_first]] = True
    return marked


def with_reduced_meshes(document: Document, triangles: int) -> Document:
    """Return a document whose meshes have at most about this many triangles."""
    return replace(document, layers=tuple(_lighter(f, triangles) for f in document.layers))


def _lighter(layer: Layer, triangles: int) -> Layer:
    domain = layer.domain
    if len(domain.mesh.triangles) <= triangles:
        return layer
    mesh = triangulate(domain.outline, triangles, holes=domain.loops[1:])
    return replace(layer, domain=replace(domain, mesh=copy_draw_order(mesh, domain.mesh)))
