"""The limbs of a shape: branches of the shortest paths from an inner point."""

from collections import defaultdict
from itertools import count
from typing import NamedTuple

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices, Integers

SHORTEST_BRANCH = 0.03  # of the longest path; a shorter branch is no limb
SLENDEREST = 1.0  # length² over area: with less a part is plump; the corner of a square has 0.8
ALIKE = 0.1  # of the longest path; limbs of more equal length are ordered by their tips


class _Parts(NamedTuple):
    """The tree of the connected parts of {path length > c} as c falls, the last part its root.

    A part begins at a peak or where two parts meet, and lasts until it meets another.

    Parameters
    ----------
    tips : int64, shape (p,)
        The farthest vertex of each part and of all its descendants.
    parents : int64, shape (p,)
        The part that begins where this part ends; −1 for none.
    bottoms : float64, shape (p,)
        The path length where it ends: −inf if it does not, inf if it is too short to be a part.
    """

    tips: Indices
    parents: Indices
    bottoms: Floats


def rank_branches(vertices: Complexes, edges: Integers, areas: Floats, ways: Floats) -> Indices:
    """Return the limb of each vertex, as a rank.

    Parameters
    ----------
    areas : float64, shape (v,)
        The area that each vertex represents.
    ways : float64, shape (v,)
        Length of the path along the edges from the common root of all limbs.

    Returns
    -------
    int64, shape (v,)
        Ranks of the limbs. A child limb ranks above its parent, and limbs of other parents do not
        come between them. Of the children of one parent the longer one ranks higher, and of equally
        long ones the one whose tip is farther to the right.

    Notes
    -----
    The join tree of the path lengths (Carr, Snoeyink and Axen 2003), without short and plump parts.
    Cost: O(e log e), and a loop over the pairs of neighbouring peaks.
    """
    peaks = _peaks(edges, ways)
    tree, parts = _join(peaks, edges, ways, shortest=SHORTEST_BRANCH * ways.max())
    while (below := ways < tree.bottoms[parts]).any():
        parts[below] = tree.parents[parts[below]]
    tips = vertices[tree.tips]
    lengths = np.round(ways[tree.tips] / (ALIKE * ways.max()))
    keys = list(zip(lengths.tolist(), tips.real.tolist(), tips.imag.tolist(), strict=True))
    own = np.bincount(parts, areas, len(tree.tips)).astype(np.float64)
    joined = _not_branches(tree, ways[tree.tips], own)
    return _numbered(tree.parents, joined, keys)[parts]


def _peaks(edges: Integers, ways: Floats) -> Indices:
    """Return the vertex (v,) at which the steepest climb from each vertex ends."""
    order = np.argsort(ways, kind="stable")
    places = np.empty_like(order)
    places[order] = np.arange(len(order))
    highest = places.copy()
    for near, far in (edges.T, edges.T[::-1]):
        np.maximum.at(highest, near, places[far])
    climbs = order[highest]
    while not np.array_equal(further := climbs[climbs], climbs):
        climbs = further
    return climbs


def _join(
    peaks: Indices, edges: Integers, ways: Floats, *, shortest: float
) -> tuple[_Parts, Indices]:
    """Return the tree of the parts, and each vertex's first part (v,)."""
    tips, leaves = np.unique(peaks, return_inverse=True)
    order = np.argsort(ways[tips], kind="stable")
    places = np.empty_like(order)
    places[order] = np.arange(len(order))
    tips, leaves = tips[order], places[leaves]  # the lower peak has the smaller number

    ends = np.sort(leaves[edges], axis=1)
    apart = np.flatnonzero(ends[:, 0] != ends[:, 1])
    passes = ways[edges[apart]].min(axis=1)
    apart, passes = apart[(falling := np.argsort(-passes, kind="stable"))], passes[falling]
    # Of all edges between two peaks only the highest matters: keep the first.
    _, first = np.unique(ends[apart] @ (len(tips), 1), return_index=True)
    first.sort()

    parts = [(tip, -1, -np.inf) for tip in tips.tolist()]
    leader = list(range(len(tips)))
    growing = list(range(len(tips)))  # the present part of each leader
    for pair, bottom in zip(ends[apart[first]].tolist(), passes[first].tolist(), strict=True):
        low, high = sorted(_lead(leader, peak) for peak in pair)
        if low == high:
            continue
        leader[low] = high
        lower, higher = growing[low], growing[high]
        if ways[tips[low]] - bottom < shortest:
            parts[lower] = (parts[lower][0], higher, np.inf)
            continue
        growing[high] = len(parts)
        for part in (lower, higher):
            parts[part] = (parts[part][0], growing[high], bottom)
        parts.append((int(tips[high]), -1, -np.inf))
    found, parents, bottoms = zip(*parts, strict=True)
    return _Parts(np.array(found), np.array(parents), np.array(bottoms)), leaves


def _lead(leader: list[int], peak: int) -> int:
    while leader[peak] != peak:
        leader[peak] = leader[leader[peak]]
        peak = leader[peak]
    return peak


def _not_branches(tree: _Parts, tops: Floats, areas: Floats) -> Booleans:
    """Mark the parts (p,) that are no limbs and belong to their parents.

    They are the plump ones. A part is measured without its limbs and with its plump children.
    """
    joined: Booleans = tree.parents >= 0
    real = np.flatnonzero(joined & (tree.bottoms < np.inf))
    tops, areas = tops.copy(), areas.copy()
    tops[tree.parents[real]] = tree.bottoms[real]
    for part in real.tolist():  # a part comes before its parent
        parent = tree.parents[part]
        joined[part] = (tops[part] - tree.bottoms[part]) ** 2 <= SLENDEREST * areas[part]
        if joined[part]:
            tops[parent] = max(tops[parent], tops[part])
            areas[parent] += areas[part]
    return joined


def _numbered(
    parents: Indices, joined: Booleans, keys: list[tuple[float, float, float]]
) -> Indices:
    """Number the limbs, each before its children, and the children by their keys."""
    limbs = np.arange(len(parents))
    grown: dict[int, list[int]] = defaultdict(list)
    for part in reversed(range(len(parents))):
        if joined[part]:
            limbs[part] = limbs[parents[part]]
        else:
            grown[limbs[parents[part]] if parents[part] >= 0 else -1].append(part)
    ranks = np.zeros(len(parents), dtype=np.int64)
    numbers = count()
    waiting = [-1]
    while waiting:
        limb = waiting.pop()
        if limb >= 0:
            ranks[limb] = next(numbers)
        waiting += sorted(grown[limb], key=keys.__getitem__, reverse=True)
    return ranks[limbs]
