"""A triangulated domain: piecewise linear maps on it, their derivatives, and paths through it."""

from dataclasses import dataclass
from typing import Self, TypeVar

import numpy as np
import numpy.typing as npt
from scipy.sparse import csc_array, csr_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import SuperLU, splu
from scipy.spatial import cKDTree

from engine.arrays import Booleans, Complexes, Floats, Indices, as_points, freeze
from engine.domain.meshing.mesh import Mesh, sides_of
from engine.errors import EngineError
from engine.geometry import as_xy
from engine.paths import MESH_POINTS, SpanningTree, breadth_first_parents, depth_first_numbering

type_ = TypeVar("type_", Complexes, Floats)
FLAT = 1e-12  # area of a triangle, over the square of its longest edge, that counts as 0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TriangleTree:
    """A spanning tree of a graph whose nodes (s,) keep their numbers.

    Parameters
    ----------
    order : intp, shape (s,)
        The nodes in the tree's own order; the first is the root.
    parent : intp, shape (s,)
        Of each node; the root is its own.
    """

    tree: SpanningTree
    order: Indices
    parent: Indices

    @classmethod
    def from_edges(cls, count: int, edges: Indices, root: int) -> Self:
        """Connect all nodes to the root by the fewest edges (e, 2)."""
        parent = breadth_first_parents(count, edges, root)
        order = depth_first_numbering(parent, root)
        place = np.empty(count, dtype=np.intp)
        place[order] = np.arange(count)
        tree = SpanningTree.of_parents(place[parent[order]])
        return cls(tree=tree, order=freeze(order), parent=freeze(parent))

    def sums(self, steps: type_) -> type_:
        """Return for each node (s,) the sum of `steps` (s,) on the path from the root."""
        sums = np.empty_like(steps)
        sums[self.order] = self.tree.sums(steps[self.order])
        return sums


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TriangulatedDomain:
    """A plane mesh of one piece, on which maps are linear in each triangle.

    Build it with `TriangulatedDomain.of`.

    Parameters
    ----------
    mesh : Mesh
        n vertices and m triangles, all counter-clockwise.
    gradient : complex128, sparse, shape (m, n)
        ∂φ_j/∂z of the hat functions: its product with the positions of the vertices is f_z of each
        triangle, and that of its conjugate is f_z̄.
    counterparts : intp, shape (e, 2)
        The two half-edges of each inner edge; number 3 t + k leads from corner k of triangle t to
        its next.
    border : bool, shape (n,)
        Whether a vertex is on the border.
    loops : int
        Number of loops of the border: 1, and one more for each hole.
    anchor : int
        The vertex whose pose is given.
    tree : TriangleTree
        Through the vertices along edges, from the anchor.
    crossings : TriangleTree
        Through the triangles across inner edges, from one at the anchor.
    """

    mesh: Mesh
    areas: Floats
    gradient: csr_array
    counterparts: Indices
    border: Booleans
    loops: int
    anchor: int
    tree: TriangleTree
    crossings: TriangleTree

    @classmethod
    def of(
        cls, points: npt.ArrayLike, triangles: npt.ArrayLike, anchor: npt.ArrayLike | None = None
    ) -> Self:
        """Check a mesh and find its trees.

        Parameters
        ----------
        triangles : int, shape (m, 3)
            All counter-clockwise, or all clockwise.
        anchor : complex, optional
            The vertex next to it becomes the anchor; by default the one farthest from the border.

        Raises
        ------
        EngineError
            If a triangle names no point or is flat, some triangles are flipped, a point is in no
            triangle, an edge is in more than two, or the triangles are not connected.
        """
        points = as_points(points, "points", at_least=3)
        corners = _oriented(points, _as_corners(triangles, len(points)))
        mesh = Mesh(vertices=points, triangles=corners.astype(np.int32))
        edges, sides, counterparts = _adjacency(corners)
        pairs = counterparts // 3
        _require_whole(corners, pairs, len(points))
        areas = mesh.areas()
        border = np.zeros(len(points), dtype=np.bool_)
        border[sides] = True
        place = _farthest(points, border) if anchor is None else _nearest(points, anchor)
        first = int(np.flatnonzero((corners == place).any(axis=1))[0])
        return cls(
            mesh=mesh,
            areas=freeze(areas),
            gradient=_gradient(points, corners, areas),
            counterparts=freeze(counterparts),
            border=freeze(border),
            # Euler: V − E + F = 2 − (loops), for a plane mesh without its outside.
            loops=2 - (len(points) - len(edges) + len(corners)),
            anchor=place,
            tree=TriangleTree.from_edges(len(points), edges, place),
            crossings=TriangleTree.from_edges(len(corners), pairs, first),
        )

    @property
    def points(self) -> Complexes:
        return self.mesh.vertices

    @property
    def corners(self) -> Indices:
        """The vertices of each triangle, intp (m, 3)."""
        return self.mesh.triangles.astype(np.intp)

    @property
    def pairs(self) -> Indices:
        """The two triangles at each inner edge, intp (e, 2)."""
        return self.counterparts // 3

    def derivatives(self, positions: Complexes) -> tuple[Complexes, Complexes]:
        """Return f_z and f_z̄ (m,) of the piecewise linear map to positions (n,)."""
        fz = np.asarray(self.gradient @ positions)
        fzbar = np.asarray(self.gradient @ positions.conj()).conj()
        return fz, fzbar

    def sums_at_vertices(self, fz: Complexes, fzbar: Complexes) -> Complexes:
        """Return the transpose of `derivatives` with the triangles' areas, complex128 (n,)."""
        similar = np.asarray(self.gradient.T @ (self.areas * fz.conj())).conj()
        return np.asarray(similar + self.gradient.T @ (self.areas * fzbar))

    def anchor_fz(self, fz: Complexes) -> complex:
        """Return the mean of f_z (m,) around the anchor."""
        near = (self.mesh.triangles == self.anchor).any(axis=1)
        return complex((self.areas[near] @ fz[near]) / self.areas[near].sum())

    def laplacian(self) -> csr_array:
        """Return Re(Dᴴ A D), D the gradient: the cotangent Laplacian (n, n), divided by 4."""
        weighted = self.gradient.copy()
        weighted.data *= np.repeat(self.areas, 3)
        return csr_array((self.gradient.conj().T @ weighted).real)


def factorise_symmetric(matrix: csr_array | csc_array) -> SuperLU:
    """Return the factors of a symmetric positive definite matrix.

    The order of elimination is recomputed each time, which is a tenth of the cost.
    """
    return splu(
        csc_array(matrix),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )


def solve_complex(factors: SuperLU, right: Complexes) -> Complexes:
    """Solve a real system for a complex right-hand side (n,)."""
    both = factors.solve(np.column_stack([right.real, right.imag]))
    return np.asarray(both[:, 0] + 1j * both[:, 1])


def _as_corners(triangles: npt.ArrayLike, count: int) -> Indices:
    corners = np.asarray(triangles)
    if corners.ndim != 2 or corners.shape[1] != 3 or corners.dtype.kind not in "iu":
        raise EngineError(
            "triangles must be integers of shape (t, 3), not {dtype} of shape {shape}.",
            dtype=corners.dtype,
            shape=corners.shape,
        )
    if not len(corners):
        raise EngineError("The mesh has no triangles; give at least one.")
    if corners.min() < 0 or corners.max() >= count:
        raise EngineError(
            MESH_POINTS, smallest=corners.min(), largest=corners.max(), last=count - 1
        )
    return corners.astype(np.intp)


def _oriented(points: Complexes, corners: Indices) -> Indices:
    """Return the triangles counter-clockwise."""
    a, b, c = points[corners.T]
    areas = 0.5 * ((b - a).conj() * (c - a)).imag
    longest = np.max(np.abs([b - a, c - b, a - c]), axis=0)
    flat = np.flatnonzero(np.abs(areas) <= FLAT * longest**2)
    if len(flat):
        raise EngineError(
            "Triangle {triangle} of the domain is flat; leave it out.", triangle=flat[0]
        )
    clockwise = areas < 0
    if clockwise.all():
        return corners[:, ::-1]
    if clockwise.any():
        rarer = clockwise if 2 * clockwise.sum() <= len(corners) else ~clockwise
        raise EngineError(
            "Triangle {triangle} of the domain is flipped, so the domain folds there. Give a "
            "mesh whose triangles all have the same orientation.",
            triangle=np.flatnonzero(rarer)[0],
        )
    return corners


def _adjacency(corners: Indices) -> tuple[Indices, Indices, Indices]:
    """Return all edges (e, 2), those on the border (b, 2), and the half-edges of inner ones."""
    edges, numbers, counterparts = sides_of(corners)
    shared = np.bincount(numbers.ravel())
    if shared.max() > 2:
        first, second = edges[shared.argmax()]
        raise EngineError(
            "The edge from point {first} to point {second} belongs to {count} triangles; an "
            "edge of a plane mesh belongs to one or two.",
            first=first,
            second=second,
            count=shared.max(),
        )
    return edges, edges[shared == 1], counterparts


def _require_whole(corners: Indices, pairs: Indices, count: int) -> None:
    """Raise an `EngineError` for points without triangles, and for triangles in several pieces."""
    unused = np.flatnonzero(np.bincount(corners.ravel(), minlength=count) == 0)
    if len(unused):
        raise EngineError("Point {point} belongs to no triangle; leave it out.", point=unused[0])
    graph = csr_array((np.ones(len(pairs), np.int8), pairs.T), shape=(len(corners),) * 2)
    pieces, number = connected_components(graph, directed=False)
    if pieces > 1:
        apart = np.flatnonzero(number != number[0])[0]
        raise EngineError(
            "Triangle {triangle} is not connected to triangle 0 by shared edges; give a mesh of "
            "one piece.",
            triangle=apart,
        )


def _gradient(points: Complexes, corners: Indices, areas: Floats) -> csr_array:
    """∂_z of the hat function at a corner is conj(i e) / 4A, e the opposite edge."""
    opposite = np.roll(points[corners], -2, axis=1) - np.roll(points[corners], -1, axis=1)
    values = (1j * opposite).conj() / (4.0 * areas[:, None])
    rows = np.arange(0, 3 * len(corners) + 1, 3)
    return csr_array((values.ravel(), corners.ravel(), rows), shape=(len(corners), len(points)))


def _farthest(points: Complexes, border: Booleans) -> int:
    xy = as_xy(points)
    distances, _ = cKDTree(xy[border]).query(xy)
    return int(np.argmax(distances))


def _nearest(points: Complexes, anchor: npt.ArrayLike) -> int:
    place = as_points(np.ravel(anchor), "anchor")
    if len(place) != 1:
        raise EngineError(
            "The mesh needs exactly one anchor, not {count}. Leave the anchor out, and Lissom "
            "chooses one.",
            count=len(place),
        )
    return int(np.abs(points - place[0]).argmin())
