"""Where handles are useful: at the tips of limbs and in the middle of the body, by the medial axis.

The axis is made of the triangles of the constrained Delaunay triangulation of a sampled boundary,
each linked to its neighbours: their circumcentres tend to the medial axis (Brandt and Algazi,
"Continuous skeleton computation by Voronoi diagram", 1992), and the links to its connectivity
(Prasad, "Morphological analysis of shapes", 1997).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.domain.meshing import sides_of
from engine.geometry import (
    Pieces,
    bisect,
    box_diagonal,
    constrained_delaunay,
    contains,
    distance_to_boundary,
    edges,
)

# Of the length of the whole boundary: the longest of its segments that are triangulated.
STEP = 1 / 300
# A limb reaches out of the body by so much of the body's half width where it leaves it, and of the
# diagonal of the box. Corners of a square reach out by 0.41, those of a regular triangle by 1.
LEAST_REACH, LEAST_SHARE = 0.6, 0.05
# The handle of a sharp tip, of which this many radii of the largest disc lie before its middle, is
# at this share of the limb; that of a round one is where discs further inwards, within so many
# radii, are hardly larger.
ROUND, SHARP = 1.5, 0.1
AHEAD, LEVEL = 0.6, 1.2
THIN = 0.25
# Of the circumradius: so far from the boundary is the centre of a circle that is empty, but for
# what the samples leave out.
EMPTY = 0.7
# Of the largest radius, which may be that of a head: what belongs to the body.
THICK = 0.4
CORNERS_OF_A_RING = 4


class MedialAxis(NamedTuple):
    """A graph of n nodes in the middle of a shape; links (m, 2) are pairs of them."""

    places: Complexes
    radii: Floats  # distances from the boundary
    links: Indices


def medial_axis(loops: Sequence[Complexes]) -> MedialAxis:
    """Return the medial axis of a shape, with a spur into each convex corner.

    The loops are its outline, counter-clockwise, and those of its holes. A node stands for a
    triangle: at its circumcentre, which is as far from the boundary as from the corners if the
    circle is empty. Where the samples are too far apart for that, it is between the midpoints of
    the sides that the triangle shares. The triangulation has no inner points, so that without holes
    the graph is a tree.
    """
    step = STEP * sum(float(abs(edges(loop)).sum()) for loop in loops)

    def is_short(pieces: Pieces) -> Booleans:
        return np.asarray(pieces.lengths <= step)

    fine = [bisect(Pieces.whole(loop, np.roll(loop, -1)), is_short).starts for loop in loops]
    vertices = np.concatenate(fine)
    triangles = constrained_delaunay(fine[0], fine[1:])
    _, _, twins = sides_of(triangles)
    is_shared = np.zeros(triangles.size, dtype=np.bool_)
    is_shared[twins] = True
    places = _between_shared_sides(vertices[triangles], is_shared.reshape(-1, 3))
    radii = distance_to_boundary(loops[0], places, loops[1:])
    centres, apart = _circumcircles(vertices[triangles])
    inside = np.flatnonzero(contains(loops[0], centres, holes=loops[1:]))
    depth = distance_to_boundary(loops[0], centres[inside], loops[1:])
    is_empty = depth >= EMPTY * apart[inside]
    places[inside[is_empty]], radii[inside[is_empty]] = centres[inside[is_empty]], depth[is_empty]
    return MedialAxis(places, radii, twins // 3)


def _between_shared_sides(corners: Complexes, is_shared: Booleans) -> Complexes:
    """Return the mean of the midpoints of the sides that triangles (t, 3) share, (t,)."""
    middles = (corners + np.roll(corners, -1, 1)) / 2
    places: Complexes = (middles * is_shared).sum(1) / np.maximum(is_shared.sum(1), 1)
    return places


def _circumcircles(corners: Complexes) -> tuple[Complexes, Floats]:
    """Return the centres (t,) and radii (t,) of the circles through the corners (t, 3)."""
    b, c = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = 2 * (b.conj() * c).imag
    centres = 1j * (abs(b) ** 2 * c - abs(c) ** 2 * b) / np.where(area == 0, np.nan, -area)
    centres = np.where(np.isfinite(centres), centres, 0)
    return corners[:, 0] + centres, np.abs(centres)


class _Branch(NamedTuple):
    """The nodes from an end of the axis up to where it forks, and how far that end reaches out."""

    path: list[int]
    lengths: list[float]
    reach: float
    needed: float


class _Tree:
    """The axis while its spurs are cut off."""

    def __init__(self, axis: MedialAxis, diagonal: float) -> None:
        self.axis = axis
        self.diagonal = diagonal
        self.near: dict[int, set[int]] = {node: set() for node in range(len(axis.places))}
        for one, other in axis.links.tolist():
            self.near[one].add(other)
            self.near[other].add(one)

    def branch(self, end: int) -> _Branch:
        """Return the branch that ends at a node with one neighbour."""
        path, lengths, before = [end], [float(self.axis.radii[end])], -1
        while True:
            node = path[-1]
            onward = [other for other in self.near[node] if other != before]
            if len(onward) != 1 or (len(path) > 1 and len(self.near[node]) > 2):
                break
            way = float(abs(self.axis.places[onward[0]] - self.axis.places[node]))
            before = node
            path.append(onward[0])
            lengths.append(lengths[-1] + way)
        at = len(path) - 1
        if len(self.near[path[-1]]) < 2:
            # It forks nowhere: each end reaches out of the middle.
            at = int(np.searchsorted(lengths, lengths[-1] / 2))
        radius = float(self.axis.radii[path[at]])
        needed = max(LEAST_REACH * radius, LEAST_SHARE * self.diagonal)
        return _Branch(path, lengths, lengths[at] - radius, needed)

    def cut_spurs(self) -> dict[int, _Branch]:
        """Cut off what reaches out too little, the least first; return what is left by its end."""
        branches = {
            node: self.branch(node) for node, others in self.near.items() if len(others) == 1
        }
        while branches:
            end = min(branches, key=lambda node: branches[node].reach / branches[node].needed)
            branch = branches[end]
            if branch.reach >= branch.needed:
                break
            fork = branch.path[-1]
            if len(self.near[fork]) < 2:
                # A shape without limbs.
                return {}
            del branches[end]
            for node in branch.path[:-1]:
                for other in self.near.pop(node):
                    self.near[other].discard(node)
            if len(self.near[fork]) == 1:
                branches[fork] = self.branch(fork)
            for other, longer in branches.items():
                if longer.path[-1] == fork:
                    branches[other] = self.branch(other)
        return branches

    def tip(self, branch: _Branch) -> int:
        """Return where on a branch a handle holds its end: in the middle of a round one."""
        radii, lengths = self.axis.radii[branch.path], np.array(branch.lengths)
        inwards = np.interp(lengths + AHEAD * radii, lengths, radii)
        is_sharp = lengths >= ROUND * radii
        is_tip = np.where(is_sharp, lengths >= SHARP * branch.reach, inwards <= LEVEL * radii)
        # What is thin at the end of a thick limb, as a thumb, is not what the limb is held by.
        is_tip &= radii >= THIN * np.median(radii)
        return branch.path[int(is_tip.argmax())] if is_tip.any() else branch.path[-1]

    def ring(self) -> list[int]:
        """Return the nodes that lie on a way around a hole, or between two of those."""
        near = {node: set(others) for node, others in self.near.items()}
        ends = [node for node, others in near.items() if len(others) < 2]
        while ends:
            node = ends.pop()
            for other in near.pop(node):
                near[other].discard(node)
                if len(near[other]) == 1:
                    ends.append(other)
        return sorted(near)


def suggest_handles(loops: Sequence[Complexes]) -> Complexes:
    """Return places for handles: the middle of the body, the tips of its limbs, and around holes.

    Parameters
    ----------
    loops : sequence of complex128
        The outline, counter-clockwise, and the outlines of the holes.

    Returns
    -------
    complex128, shape (h,)
        All inside, the middle first.

    Notes
    -----
    Spurs of the medial axis that reach out of the body by little are cut off, the least one first;
    what is left are limbs. The middle is the node that is nearest to all tips, among those where
    the shape is thick.
    """
    tree = _Tree(medial_axis(loops), box_diagonal(loops[0]))
    branches = tree.cut_spurs()
    tips = [tree.tip(branch) for branch in branches.values()]
    kept = np.array(sorted(tree.near))
    axis, number = tree.axis, {int(node): index for index, node in enumerate(kept)}
    pairs = [(number[node], number[other]) for node in number for other in tree.near[node]]
    rows, columns = np.array(pairs, dtype=np.intp).reshape(-1, 2).T
    ways = np.abs(axis.places[kept[rows]] - axis.places[kept[columns]])
    graph = coo_array((np.maximum(ways, 1e-12), (rows, columns)), shape=(len(kept), len(kept)))
    radii = axis.radii[kept]
    thick = np.flatnonzero(radii >= THICK * radii.max())
    # A shape without limbs is nearest to all of its ends.
    goals = [number[tip] for tip in tips] or list(range(len(kept)))
    middle = int(thick[dijkstra(graph.tocsr(), indices=goals)[:, thick].max(axis=0).argmin()])
    chosen = [middle, *(number[tip] for tip in tips)]
    ring = np.array([number[node] for node in tree.ring()], dtype=np.intp)
    if ring.size:
        on_ring = np.isin(rows, ring) & np.isin(columns, ring)
        around = float(ways[on_ring].sum()) / 2 / max(1, len(loops) - 1)
        while True:
            away = dijkstra(graph.tocsr(), indices=chosen).min(axis=0)[ring]
            # In four places each half of a ring is held at its ends and in its middle.
            if away.max() < 0.75 * around / CORNERS_OF_A_RING:
                break
            chosen.append(int(ring[away.argmax()]))
    suggested: Complexes = axis.places[kept[chosen]]
    return suggested
