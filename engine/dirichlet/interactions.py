"""The interaction lists of a fast multipole method: which panels act on which points, and how.

Panels are grouped in clusters along the outline, each of two clusters of the level below. Points
are grouped in squares, which are cut into quarters where this saves work. A cluster far from a
square acts on all of its points through one multipole expansion and one Taylor polynomial
(Greengard and Rokhlin 1987). A panel whose disc is near but whose segment is far contributes to the
polynomial directly. All pairs left at the smallest squares are near.
"""

from dataclasses import dataclass
from itertools import pairwise, starmap
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices, ragged_indices
from engine.dirichlet.panels import Panels
from engine.dirichlet.product_integration import near_distance
from engine.dirichlet.quadtree import DEEPEST, Grid, Level, Squares

# Distance of far pairs, over the radius of a square or cluster; expansions err by FAR^-TERMS.
FAR = 2.5
# Pairs of points and clusters in a square above which it is cut into quarters:
# integrating them exactly costs about as much as the expansions of four more squares.
FEW_PAIRS = 128


class Pairs(NamedTuple):
    """Squares and the clusters that act on them, intp (n,) each."""

    squares: Indices
    clusters: Indices

    def of(self, which: Booleans | Indices | slice) -> "Pairs":
        """Return some of the pairs."""
        return Pairs(self.squares[which], self.clusters[which])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Clusters:
    """Discs around panels, around pairs of these, and so on; the panels come first.

    Attributes
    ----------
    firsts : intp, shape (l + 1,)
        The first cluster of each level, and the number of all.
    centre, radius : complex128 and float64, shape (c,)
    reach : float64, shape (c,)
        Distance from the centre beyond which plain quadrature and the moments are accurate.
    level : intp, shape (c,)
    """

    firsts: Indices
    centre: Complexes
    radius: Floats
    reach: Floats
    level: Indices

    @classmethod
    def of(cls, panels: Panels) -> Self:
        """Join neighbours until one cluster is left."""
        ends = np.stack([panels.origin, panels.origin + panels.span])
        low, high = [_corners(ends)], [-_corners(-ends)]
        near = [near_distance(panels.power) * np.abs(panels.span)]
        while len(low[-1]) > 1:
            pairs = np.arange(0, len(low[-1]), 2)
            low.append(np.minimum.reduceat(low[-1], pairs))
            high.append(np.maximum.reduceat(high[-1], pairs))
            near.append(np.maximum.reduceat(near[-1], pairs))
        counts = [len(each) for each in low]
        lowest, highest = np.concatenate(low), np.concatenate(high)
        centre, extent = (lowest + highest) / 2, (highest - lowest) / 2
        radius = np.hypot(extent[:, 0], extent[:, 1])
        return cls(
            firsts=np.cumsum([0, *counts]),
            centre=centre[:, 0] + 1j * centre[:, 1],
            radius=radius,
            reach=np.maximum(FAR * radius, radius + np.concatenate(near)),
            level=np.repeat(np.arange(len(counts)), counts),
        )

    def children(self, clusters: Indices) -> tuple[Indices, Indices]:
        """Return the children (n,) of clusters above the panels, and the parent (n,) of each."""
        level = self.level[clusters]
        first = self.firsts[level - 1] + 2 * (clusters - self.firsts[level])
        both = np.column_stack([first, first + 1])
        there = both < self.firsts[level, None]
        return both[there], np.nonzero(there)[0]


class Interactions(NamedTuple):
    """The squares, the clusters, and the pairs of them, sorted by square.

    `direct` and `near` refer to panels; `near` refers to leaves only.
    """

    squares: Squares
    clusters: Clusters
    far: Pairs
    direct: Pairs
    near: Pairs


def find_interactions(panels: Panels, points: Complexes) -> Interactions:
    """Sort points (t,), at least one, into squares, and find the pairs of each square."""
    clusters = Clusters.of(panels)
    search = _Search(panels, clusters)
    grid = Grid.around(points)
    level = Level.whole(grid)
    waiting = Pairs(np.zeros(1, dtype=np.intp), np.array([len(clusters.centre) - 1]))
    levels, leaves = [], []
    while len(level.starts):
        levels.append(level)
        waiting = search.settled(waiting, level)
        is_leaf = search.is_leaf(waiting, level) | (level.depth == DEEPEST)
        leaves.append(is_leaf)
        of_leaf = is_leaf[waiting.squares]
        search.finish(waiting.of(of_leaf), level)
        following = level.quarters(grid, ~is_leaf)
        waiting = _handed_down(waiting.of(~of_leaf), level, following)
        level = following
    firsts = [each.first for each in levels] + [level.first]
    starts = np.concatenate([each.starts for each in levels])
    uncut = np.flatnonzero(np.concatenate(leaves))
    squares = Squares(
        order=grid.order,
        starts=starts,
        ends=np.concatenate([each.ends for each in levels]),
        centre=np.concatenate([each.centre for each in levels]),
        radius=np.concatenate([np.full(len(each.starts), each.radius) for each in levels]),
        parent=np.concatenate([each.parent for each in levels]),
        quadrant=np.concatenate([each.quadrant for each in levels]),
        leaves=uncut[np.argsort(starts[uncut])],
        levels=tuple(starmap(slice, pairwise(firsts))),
    )
    return Interactions(
        squares,
        clusters,
        far=_by_square(search.far),
        direct=_by_square(search.direct),
        near=_by_square(search.near),
    )


class _Search:
    """The pairs found so far, with the squares' numbers among all squares."""

    def __init__(self, panels: Panels, clusters: Clusters) -> None:
        self._clusters = clusters
        self._panels = panels
        self._near = near_distance(panels.power) * np.abs(panels.span)
        self.far: list[Pairs] = []
        self.direct: list[Pairs] = []
        self.near: list[Pairs] = []

    def settled(self, pairs: Pairs, level: Level) -> Pairs:
        """Remove far pairs, and open clusters that are larger than the squares."""
        waiting = []
        while len(pairs.squares):
            pairs = self._without_far(pairs, level)
            large = self._clusters.radius[pairs.clusters] > level.radius
            opened = large & (self._clusters.level[pairs.clusters] > 0)
            waiting.append(pairs.of(~opened))
            pairs = self._opened(pairs.of(opened))
        return _joined(waiting)

    def finish(self, pairs: Pairs, level: Level) -> None:
        """Open all clusters of leaves."""
        while len(pairs.squares):
            above = self._clusters.level[pairs.clusters] > 0
            self.near.append(_numbered(pairs.of(~above), level))
            pairs = self._without_far(self._opened(pairs.of(above)), level)

    def is_leaf(self, waiting: Pairs, level: Level) -> Booleans:
        """Return which squares are not worth cutting."""
        count = len(level.starts)
        waits = np.bincount(waiting.squares, minlength=count)
        # Quarters of a square much smaller than its near panels would have the same near panels.
        small = self._clusters.radius[waiting.clusters] < 2 * level.radius
        gains = np.bincount(waiting.squares, small, minlength=count) > 0
        few: Booleans = waits * (level.ends - level.starts) <= FEW_PAIRS
        return few | ~gains

    def _without_far(self, pairs: Pairs, level: Level) -> Pairs:
        clusters = self._clusters
        size, own = level.radius, pairs.clusters
        gap = np.abs(level.centre[pairs.squares] - clusters.centre[own])
        far = gap >= np.maximum(size + clusters.reach[own], clusters.radius[own] + FAR * size)
        self.far.append(_numbered(pairs.of(far), level))
        pairs = pairs.of(~far)
        single = np.flatnonzero(clusters.level[pairs.clusters] == 0)
        panel, panels = pairs.clusters[single], self._panels
        starts = panels.origin[panel]
        gap = _distance(level.centre[pairs.squares[single]], starts, starts + panels.span[panel])
        direct = single[gap >= np.maximum(FAR * size, size + self._near[panel])]
        self.direct.append(_numbered(pairs.of(direct), level))
        left = np.ones(len(pairs.squares), dtype=np.bool_)
        left[direct] = False
        return pairs.of(left)

    def _opened(self, pairs: Pairs) -> Pairs:
        children, of = self._clusters.children(pairs.clusters)
        return Pairs(pairs.squares[of], children)


def _corners(places: Complexes) -> Floats:
    """Return the lower left corners (p, 2) of boxes around columns of points (n, p)."""
    return np.column_stack([places.real.min(axis=0), places.imag.min(axis=0)])


def _distance(points: Complexes, starts: Complexes, ends: Complexes) -> Floats:
    """Return the distance of each point (n,) from its own segment."""
    along, offset = ends - starts, points - starts
    place = np.clip((offset * along.conj()).real / np.abs(along) ** 2, 0.0, 1.0)
    distance: Floats = np.abs(offset - place * along)
    return distance


def _handed_down(waiting: Pairs, level: Level, quarters: Level) -> Pairs:
    """Return the pairs of the quarters: all pairs that were left for their squares."""
    parent = quarters.parent - level.first
    counts = np.bincount(waiting.squares, minlength=len(level.starts))
    order = np.argsort(waiting.squares, kind="stable")
    quarter, place = ragged_indices(counts[parent])
    own = order[(np.cumsum(counts) - counts)[parent[quarter]] + place]
    return Pairs(quarter, waiting.clusters[own])


def _numbered(pairs: Pairs, level: Level) -> Pairs:
    return Pairs(pairs.squares + level.first, pairs.clusters)


def _joined(parts: list[Pairs]) -> Pairs:
    none = np.empty(0, dtype=np.intp)
    squares = np.concatenate([none, *[part.squares for part in parts]])
    return Pairs(squares, np.concatenate([none, *[part.clusters for part in parts]]))


def _by_square(parts: list[Pairs]) -> Pairs:
    pairs = _joined(parts)
    return pairs.of(np.lexsort((pairs.clusters, pairs.squares)))
