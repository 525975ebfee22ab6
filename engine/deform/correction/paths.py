"""Short quadrature along straight legs from an anchor to a few points (Section 7)."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np
import scipy.linalg
from scipy.spatial import cKDTree

from engine.arrays import Booleans, Complexes, Floats, Indices, freeze
from engine.deform.correction.products import products_along
from engine.geometry import Pieces, as_xy, bisect_segments
from engine.maps import Boundary
from engine.paths import Loops, leave_region, scattered_network

GAUSS = 5  # nodes of a piece
# Longest piece over its distance to the nearest singularity, and the least distance that counts,
# over the domain's diameter. The error is then some 1e-6 of the diameter.
PIECE_PER_DISTANCE, LEAST_DISTANCE = 1.5, 2e-3
LOOKED_AT = 9  # places of a leg at which its pieces are counted
SPANS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96)  # corners that a tried leg may skip
LARGEST_PRICE = 1e6  # of a leg inside the domain
SHARED = 0.05  # part of its price for a leg that already leads to another point


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointPaths:
    """Quadrature nodes on paths from an anchor to points, and on loops around holes.

    Parameters
    ----------
    nodes, steps : complex128, shape (s,)
        The nodes of one leg after the other, and dz there.
    starts : intp, shape (l,)
        The first node of each leg.
    passes : float64, shape (m + holes, l)
        1 where the path to a point, or the loop around a hole, has the leg.
    """

    nodes: Complexes
    steps: Complexes
    starts: Indices
    passes: Floats

    @classmethod
    def of(cls, boundary: Boundary, anchor: complex, points: Complexes) -> Self:
        """Lay paths of few pieces inside a domain."""
        outline, *holes = boundary.loops
        singular = np.concatenate([boundary.span.vertices, *boundary.loops])
        around = Loops.around(outline, holes, singular)
        if not len(points):
            return cls.around(around)
        near = cKDTree(as_xy(singular))
        ways = _ways(boundary, anchor, points, near)
        legs = list(dict.fromkeys(leg for way in ways for leg in way))
        starts, ends = (np.array([leg[k] for leg in legs]) for k in (0, 1))
        pieces = bisect_segments(
            Pieces.whole(starts, ends), lambda p: _are_fine(p, near, boundary.size)
        )
        x, w = np.polynomial.legendre.leggauss(GAUSS)
        spans = (pieces.ends - pieces.starts)[:, None]
        nodes = (pieces.starts[:, None] + spans * (1 + x) / 2).ravel()
        lengths = (spans * w / 2).ravel()
        number = {leg: i for i, leg in enumerate(legs)}
        passes = np.zeros((len(points), len(legs)))
        for row, way in zip(passes, ways, strict=True):
            row[[number[leg] for leg in way]] = 1.0
        own = GAUSS * np.searchsorted(pieces.segment, np.arange(len(legs)))
        return cls(
            nodes=freeze(np.concatenate([nodes, around.nodes])),
            steps=freeze(np.concatenate([lengths, around.differentials])),
            starts=freeze(np.concatenate([own, len(nodes) + around.starts])),
            passes=freeze(scipy.linalg.block_diag(passes, np.eye(len(holes)))),
        )

    @classmethod
    def around(cls, loops: Loops) -> Self:
        """Take only loops around holes, without points."""
        count = len(loops.starts)
        return cls(
            nodes=loops.nodes, steps=loops.differentials, starts=loops.starts, passes=np.eye(count)
        )

    def integrals(self, values: Complexes) -> Complexes:
        """Integrate values (..., s) along the paths and loops, (..., m + holes)."""
        legs = np.add.reduceat(values * self.steps, self.starts, axis=-1)
        return np.asarray(legs.real @ self.passes.T + 1j * (legs.imag @ self.passes.T))

    def products_with(self, values: Complexes, functions: Complexes) -> Complexes:
        """Integrate values (k, s) times functions (r, s): (k, m + holes, r)."""
        weights, ends = values * self.steps, [*self.starts.tolist(), len(self.nodes)]
        legs = [products_along(weights[:, a:b], functions[:, a:b]) for a, b in pairwise(ends)]
        # As reals, since the paths are.
        totals = np.tensordot(self.passes, np.array(legs).view(np.float64), axes=1)
        return totals.view(np.complex128).swapaxes(0, 1)

    def spread(self, pulls: Complexes) -> Complexes:
        """Return dz times the sum of the pulls (m + holes,) whose paths pass each node, (s,)."""
        counts = np.diff(self.starts, append=len(self.nodes))
        return np.asarray(np.repeat(pulls @ self.passes, counts) * self.steps)


PathLeg = tuple[complex, complex]


def _are_fine(pieces: Pieces, near: cKDTree, size: float) -> Booleans:
    """Whether pieces are short compared with their distance to the singularities."""
    starts, ends = pieces.starts, pieces.ends
    places = np.stack([starts, (starts + ends) / 2, ends])
    room = _distances(places, near).min(axis=0)
    room = np.maximum(room, LEAST_DISTANCE * size)
    return np.asarray(pieces.lengths <= PIECE_PER_DISTANCE * room)


def _distances(places: Complexes, near: cKDTree) -> Floats:
    return np.asarray(near.query(as_xy(places.ravel()))[0]).reshape(places.shape)


def _ways(
    boundary: Boundary, anchor: complex, points: Complexes, near: cKDTree
) -> list[list[PathLeg]]:
    """Return the legs of a path to each point: the cheapest chain of corners of a known path."""
    outline, *holes = boundary.loops
    network = scattered_network(outline, points, np.array([anchor]), holes=holes)
    chains = []
    for place in network.places:
        way = [int(place)]
        while way[-1]:
            way.append(int(network.parents[way[-1]]))
        chains.append(network.nodes[way[::-1]])
    tried = [_legs_tried(len(chain)) for chain in chains]
    starts, ends = (
        np.concatenate([chain[legs[:, k]] for chain, legs in zip(chains, tried, strict=True)])
        for k in (0, 1)
    )
    prices = _prices(starts, ends, near, boundary.size)
    prices[leave_region(boundary.loops, starts, ends)] = np.inf
    ways: list[list[PathLeg]] = []
    used: set[PathLeg] = set()
    parts = np.split(prices, np.cumsum([len(legs) for legs in tried])[:-1])
    for chain, legs, own in zip(chains, tried, parts, strict=True):
        # Legs of the known path are inside, regardless of rounding.
        known = np.where(legs[:, 1] - legs[:, 0] == 1, np.minimum(own, LARGEST_PRICE), own)
        ways.append(_cheapest(chain.tolist(), legs, known, used))
        used.update(ways[-1])
    return ways


def _legs_tried(count: int) -> Indices:
    """Return the pairs of corners of a chain between which legs are tried, (t, 2), in order."""
    first, last = np.triu_indices(count, 1)
    tried = np.isin(last - first, SPANS) | (first == 0) | (last == count - 1)
    order = np.lexsort((first[tried], last[tried]))
    return np.column_stack([first[tried], last[tried]])[order]


def _prices(starts: Complexes, ends: Complexes, near: cKDTree, size: float) -> Floats:
    """Estimate the pieces of legs: their lengths over the distances along them."""
    shares = (np.arange(LOOKED_AT) + 0.5) / LOOKED_AT
    places = starts[:, None] + (ends - starts)[:, None] * shares
    room = _distances(places, near)
    room = np.maximum(room, LEAST_DISTANCE * size)
    prices: Floats = np.abs(ends - starts) * (1.0 / room).mean(axis=1) / PIECE_PER_DISTANCE
    return np.maximum(prices, 1.0)


def _cheapest(
    chain: list[complex], tried: Indices, prices: Floats, used: set[PathLeg]
) -> list[PathLeg]:
    best, came = [0.0] + [np.inf] * (len(chain) - 1), [0] * len(chain)
    for (i, j), price in zip(tried.tolist(), prices.tolist(), strict=True):
        cost = best[i] + price * (SHARED if (chain[i], chain[j]) in used else 1.0)
        if cost < best[j]:
            best[j], came[j] = cost, i
    legs: list[PathLeg] = []
    j = len(chain) - 1
    while j:
        legs.append((chain[came[j]], chain[j]))
        j = came[j]
    return legs[::-1]
