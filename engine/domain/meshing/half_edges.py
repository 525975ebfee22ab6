"""A triangulation that can be edited in bulk: edge flips, new points, split boundary edges.

Half-edge 3t + k leads from corner k of triangle t to the next corner, counter-clockwise. Its
counterpart is the same edge in the neighbouring triangle. Every operation takes many half-edges or
triangles at once and keeps the triangulation a conforming manifold, whatever the coordinates are.
"""

import numpy as np
import numpy.typing as npt

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.domain.meshing.mesh import sides_of

# Counterparts of half-edges on the outline, and of those at the limit of the edited region.
OUTLINE, SEAM = -1, -2
ROUNDING = 1e-11  # where a sign decides, smaller numbers are zero; the region must be of size 1
FLAT = (
    1e-6  # height of a point over an edge, over the edge's length, below which it lies on the edge
)
LONGEST_WALK = 1_000  # triangles after which a walk is given up


def following(half_edges: Indices) -> Indices:
    """Return the next half-edge in the same triangle."""
    return np.where(half_edges % 3 == 2, half_edges - 2, half_edges + 1)


def preceding(half_edges: Indices) -> Indices:
    """Return the previous half-edge in the same triangle."""
    return np.where(half_edges % 3 == 0, half_edges + 2, half_edges - 1)


def disjoint(*claims: Indices, among: int) -> Booleans:
    """Choose rows that may be edited together: no two of them claim the same triangle.

    Of rows that claim the same triangle the last one wins; the last row is always chosen.

    Parameters
    ----------
    *claims : intp, shape (r,)
        Triangles that each row needs; a negative number is no claim.
    among : int
        Number of triangles.
    """
    row = np.arange(len(claims[0]))
    owner = np.full(among + 1, -1)  # the last entry absorbs negative numbers
    for claim in claims:
        np.maximum.at(owner, claim, row)
    kept = [(claim < 0) | (owner[claim] == row) for claim in claims]
    return np.asarray(np.all(kept, axis=0))


class HalfEdgeMesh:
    """A triangulation of a region that is being edited.

    Parameters
    ----------
    triangles : intp, shape (m, 3)
        Counter-clockwise; each edge in one or two triangles.

    Attributes
    ----------
    origins : intp, shape (3 m,)
        Vertex at which each half-edge starts.
    counterparts : intp, shape (3 m,)
        Half-edge of the neighbour, or `OUTLINE` or `SEAM`.
    waiting : intp, shape (w,)
        Vertices without triangles that are still to be inserted.
    places : intp, shape (w,)
        Triangle around each waiting vertex, kept up to date by `flip` and `insert`.
    """

    __slots__ = ("counterparts", "origins", "places", "points", "waiting")

    def __init__(self, points: Complexes, triangles: Indices) -> None:
        self.points = points
        self.origins = np.array(triangles, dtype=np.intp).ravel()  # A copy, to be edited.
        self.counterparts = np.full(len(self.origins), OUTLINE)
        _, _, counterparts = sides_of(self.triangles)
        self._join(*counterparts.T)
        self.waiting = self.places = np.empty(0, dtype=np.intp)

    @property
    def triangles(self) -> Indices:
        """The corners (m, 3) of the triangles."""
        return self.origins.reshape(-1, 3)

    @property
    def count(self) -> int:
        """The number of triangles."""
        return len(self.origins) // 3

    def ends(self, half_edges: Indices) -> tuple[Indices, Indices]:
        return self.origins[half_edges], self.origins[following(half_edges)]

    def end_points(self, half_edges: Indices) -> tuple[Complexes, Complexes]:
        start, end = self.ends(half_edges)
        return self.points[start], self.points[end]

    def add_points(self, points: Complexes) -> Indices:
        """Append points without triangles, and return their indices."""
        first = len(self.points)
        self.points = np.concatenate([self.points, points])
        return np.arange(first, len(self.points))

    def flip(self, half_edges: Indices) -> Indices:
        """Replace inner edges a-b of triangles abc, bad by the other diagonals c-d.

        No triangle may occur twice. Returns the half-edges around the quadrilaterals.
        """
        ab, ba = half_edges, self.counterparts[half_edges]
        ca, db = preceding(ab), preceding(ba)
        bc, ad = following(ab), following(ba)
        c, d = self.origins[ca], self.origins[db]
        # abc becomes dbc and bad becomes cad. Edges b-c and a-d stay in their places, d-b moves to
        # the place of a-b, and c-a to that of b-a; the diagonal takes the places that they leave.
        self._move(np.concatenate([db, ca]), np.concatenate([ab, ba]))
        self.origins[ab], self.origins[ba] = d, c
        self._join(ca, db)
        self._follow_flips(ab, ba)
        return np.concatenate([ab, bc, ba, ad])

    def insert_where_possible(
        self, vertices: Indices, triangles: Indices
    ) -> tuple[Booleans, Indices]:
        """Insert vertices into the triangles around them, as many as is possible at once.

        Returns the mask (r,) of the inserted vertices, and the half-edges (s,) that may not be
        Delaunay any more.
        """
        corners = self.points[self.triangles[triangles]]
        along = np.roll(corners, -1, axis=1) - corners
        height = _height(corners, along, self.points[vertices]) / np.abs(along)
        nearest = np.argmin(height, axis=1)
        # A point on an edge makes a flat triangle with it, which is flipped away at once.
        flat = height.min(axis=1, initial=1.0) < FLAT
        across = np.where(flat, self.counterparts[3 * triangles + nearest] // 3, -1)
        inserted = disjoint(triangles, across, among=self.count)
        around = self.insert(vertices[inserted], triangles[inserted])
        flat &= across >= 0
        flattened = around[nearest[inserted], np.arange(around.shape[1])][flat[inserted]]
        return inserted, np.concatenate([around.ravel(), self.flip(flattened)])

    def insert(self, vertices: Indices, triangles: Indices) -> Indices:
        """Join each new vertex to the corners of the triangle around it.

        Returns the half-edges around the former triangles, those of edge k of every triangle in row
        k, shape (3, r).
        """
        ab = 3 * triangles
        bc = 3 * (self.count + np.arange(len(vertices)))
        ca = bc + 3 * len(vertices)
        a, b, c = self.origins[ab], self.origins[ab + 1], self.origins[ab + 2]
        self._grow(2 * len(vertices))
        self._move(np.concatenate([ab + 1, ab + 2]), np.concatenate([bc, ca]))
        for first, start, end in ((ab, a, b), (bc, b, c), (ca, c, a)):
            self.origins[first], self.origins[first + 1] = start, end
            self.origins[first + 2] = vertices
        for first, second in ((ab, bc), (bc, ca), (ca, ab)):
            self._join(first + 1, second + 2)
        self._follow_inserts(ab, bc, ca)
        return np.stack([ab, bc, ca])

    def split_border(self, vertices: Indices, half_edges: Indices) -> Indices:
        """Split half-edges a-b without counterpart at new vertices, and their triangles abc in two.

        No triangle may occur twice. Returns the half-edges around the former triangles.
        """
        ab, bc, ca = half_edges, following(half_edges), preceding(half_edges)
        b, c = self.origins[bc], self.origins[ca]
        rest = 3 * (self.count + np.arange(len(vertices)))
        border = self.counterparts[ab]
        self._grow(len(vertices))
        self._move(bc, rest + 1)
        self.origins[bc] = vertices
        self.origins[rest], self.origins[rest + 1], self.origins[rest + 2] = vertices, b, c
        self.counterparts[rest] = border
        self._join(bc, rest + 2)
        return np.concatenate([ab, ca, rest, rest + 1])

    def restore_delaunay(self, suspects: Indices) -> None:
        """Flip edges until all are Delaunay; `suspects` are all half-edges that may not be."""
        while len(suspects):
            counterparts = self.counterparts[suspects]
            once = np.zeros(len(self.counterparts), dtype=np.bool_)
            once[np.minimum(suspects, counterparts)[counterparts >= 0]] = True
            suspects = np.flatnonzero(once)
            suspects = suspects[self._violates_delaunay(suspects)]
            chosen = disjoint(suspects // 3, self.counterparts[suspects] // 3, among=self.count)
            around = self.flip(suspects[chosen])
            suspects = np.concatenate([suspects[~chosen], around])

    def _violates_delaunay(self, half_edges: Indices) -> Booleans:
        """Mark the inner edges a-b whose opposite angles at c and d sum to over 180°.

        For triangles of positive area this makes acbd convex, up to rounding, so convexity is
        tested as well.
        """
        counterparts = self.counterparts[half_edges]
        a, b = self.end_points(half_edges)
        c = self.points[self.origins[preceding(half_edges)]]
        d = self.points[self.origins[preceding(counterparts)]]
        product = (b - c) * (a - c).conj() * (a - d) * (b - d).conj()
        across = c - d
        convex = ((across.conj() * (b - d)).imag < 0) & ((across.conj() * (a - d)).imag > 0)
        return np.asarray(convex & (product.imag < -ROUNDING * np.abs(product)))

    def walk(self, starts: Indices, targets: Complexes) -> tuple[Indices, Indices]:
        """Walk straight from the middle of triangles to targets, as far as the region reaches.

        Returns the triangles (r,) where the walks ended and the exits (r,): -1 if the target lies
        in that triangle, else the half-edge on the border that the walk would have crossed. (If
        rounding made a walk circle, any half-edge.)
        """
        triangles, exits = starts.copy(), np.full(len(starts), -1)
        sources = self.points[self.triangles[starts]].mean(axis=1)
        walking = np.arange(len(starts))
        for _ in range(LONGEST_WALK):
            if not len(walking):
                break
            leaving, edge = self._exit(triangles[walking], sources[walking], targets[walking])
            walking, edge = walking[leaving], edge[leaving]
            counterparts = self.counterparts[edge]
            exits[walking[counterparts < 0]] = edge[counterparts < 0]
            walking, counterparts = walking[counterparts >= 0], counterparts[counterparts >= 0]
            triangles[walking] = counterparts // 3
        exits[walking] = 3 * triangles[walking]
        return triangles, exits

    def _exit(
        self, triangles: Indices, sources: Complexes, targets: Complexes
    ) -> tuple[Booleans, Indices]:
        """Mark the targets outside of their triangles, and return the edges towards them."""
        corners = self.points[self.triangles[triangles]]
        along = np.roll(corners, -1, axis=1) - corners
        outside = _height(corners, along, targets) < -ROUNDING
        side = ((targets - sources).conj()[:, None] * (corners - sources[:, None])).imag
        ahead = (side <= 0) & (np.roll(side, -1, axis=1) >= 0)
        edge = np.argmax(outside * (1 + ahead), axis=1)
        return np.asarray(outside.any(axis=1)), 3 * triangles + edge

    def _grow(self, triangles: int) -> None:
        """Make room for more triangles."""
        empty = np.full(3 * triangles, OUTLINE)
        self.origins = np.concatenate([self.origins, empty])
        self.counterparts = np.concatenate([self.counterparts, empty])

    def _move(self, old: Indices, new: Indices) -> None:
        """Update the counterparts of half-edges moved from `old` to `new` in the arrays."""
        place: npt.NDArray[np.intp] = np.arange(len(self.counterparts))
        place[old] = new
        counterparts = self.counterparts[old]
        inner = counterparts >= 0
        # Counterparts may move at the same time.
        counterparts[inner] = place[counterparts[inner]]
        self.counterparts[new] = counterparts
        self.counterparts[counterparts[inner]] = new[inner]

    def _follow_flips(self, left: Indices, right: Indices) -> None:
        """Update the places of waiting vertices, for half-edges d-b and c-a of new dbc, cad."""
        row, pair = self._waiting_in(left // 3, right // 3)
        c, d = self.points[self.origins[right[pair]]], self.points[self.origins[left[pair]]]
        is_left = ((d - c).conj() * (self.points[self.waiting[row]] - c)).imag >= 0
        self.places[row] = np.where(is_left, left[pair], right[pair]) // 3

    def _follow_inserts(self, *around: Indices) -> None:
        """Update the places of waiting vertices, given the edges opposite to the inserted ones."""
        row, which = self._waiting_in(around[0] // 3)
        inner = np.stack([half_edges[which] for half_edges in around])
        middle = self.points[self.origins[preceding(inner[0])]]
        spokes = self.points[self.origins[inner]] - middle
        side = (spokes.conj() * (self.points[self.waiting[row]] - middle)).imag
        sector = np.argmax(np.minimum(side, -np.roll(side, -1, axis=0)), axis=0)
        self.places[row] = inner[sector, np.arange(len(row))] // 3

    def _waiting_in(self, *triangles: Indices) -> tuple[Indices, Indices]:
        """Return the rows of `waiting` in these triangles, and the columns of the triangles."""
        column = np.full(self.count, -1)
        for row in triangles:
            column[row] = np.arange(len(row))
        column = column[self.places]
        found = np.flatnonzero(column >= 0)
        return found, column[found]

    def _join(self, first: Indices, second: Indices) -> None:
        """Make half-edges each other's counterparts."""
        self.counterparts[first], self.counterparts[second] = second, first


def _height(corners: Complexes, along: Complexes, points: Complexes) -> Floats:
    """Return the distance (r, 3) of points to the left of the three edges of their triangle."""
    return np.asarray((along.conj() * (points[:, None] - corners)).imag / np.abs(along))
