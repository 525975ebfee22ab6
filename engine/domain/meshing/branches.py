"""The limbs of a shape: where the ways that lead outwards from a point inside it part."""

from collections import defaultdict
from itertools import count
from typing import NamedTuple

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices, Integers

SHORTEST_BRANCH = 0.03  # of the longest way; what rises less is no limb
SLENDEREST = 1.0  # length² over area: what has less is plump; the corner of a square has 0.8
ALIKE = 0.1  # of the longest way; limbs whose lengths differ less are told apart by their tips


class _Parts(NamedTuple):
    """The tree of the connected parts of {way > c} as c falls, the last part its root.

    A part begins at a peak or where two parts meet, and lasts until it meets another.

    Parameters
    ----------
    tips : int64, shape (p,)
        The farthest vertex of each part and of all that leads to it.
    parents : int64, shape (p,)
        What begins where a part ends; −1 where nothing does.
    bottoms : float64, shape (p,)
        The way where it ends: −inf where it does not, inf where it is too short to be a part.
    """

    tips: Indices
    parents: Indices
    bottoms: Floats


def rank_branches(vertices: Complexes, edges: Integers, areas: Floats, ways: Floats) -> Indices:
    """Tell for each vertex on which limb it is.

    Parameters
    ----------
    vertices, edges : complex128, shape (v,), and int32, shape (e, 2)
    areas : float64, shape (v,)
        What each vertex stands for.
    ways : float64, shape (v,)
        How long the way is from the point that all limbs grow from, along the edges.

    Returns
    -------
    int64, shape (v,)
        Ranks of the limbs. One that grows from another ranks higher, and limbs that grow from
        different ones do not come between them. Of limbs that grow from the same one the longer one
        ranks higher, and of those as long the one whose tip is farther to the right.

    Notes
    -----
    The join tree of the ways (Carr, Snoeyink and Axen 2003), from which short and plump parts are
    taken. Cost: O(e log e), and a loop over the pairs of peaks that are neighbours.
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
    """Return at which vertex (v,) the steepest climb from each vertex ends."""
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
    """Return the tree of the parts, and from which part (v,) on each vertex belongs to them."""
    tips, leaves = np.unique(peaks, return_inverse=True)
    order = np.argsort(ways[tips], kind="stable")
    places = np.empty_like(order)
    places[order] = np.arange(len(order))
    tips, leaves = tips[order], places[leaves]  # the lower peak has the smaller number

    ends = np.sort(leaves[edges], axis=1)
    apart = np.flatnonzero(ends[:, 0] != ends[:, 1])
    passes = ways[edges[apart]].min(axis=1)
    apart, passes = apart[(falling := np.argsort(-passes, kind="stable"))], passes[falling]
    # Of all edges between two peaks only the highest matters, the first of them.
    _, first = np.unique(ends[apart] @ (len(tips), 1), return_index=True)
    first.sort()

    parts = [(tip, -1, -np.inf) for tip in tips.tolist()]
    leader = list(range(len(tips)))
    growing = list(range(len(tips)))  # the part, of a leader
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
    """Tell which parts (p,) are no limbs of their own but belong to what begins where they end.

    They are those that are plump, each without the limbs and with the plump parts that lead to it.
    """
    joined: Booleans = tree.parents >= 0
    real = np.flatnonzero(joined & (tree.bottoms < np.inf))
    tops, areas = tops.copy(), areas.copy()
    tops[tree.parents[real]] = tree.bottoms[real]
    for part in real.tolist():  # a part comes before what begins where it ends
        parent = tree.parents[part]
        joined[part] = (tops[part] - tree.bottoms[part]) ** 2 <= SLENDEREST * areas[part]
        if joined[part]:
            tops[parent] = max(tops[parent], tops[part])
            areas[parent] += areas[part]
    return joined


def _numbered(
    parents: Indices, joined: Booleans, keys: list[tuple[float, float, float]]
) -> Indices:
    """Number the limbs, each before those that grow from it and these by their keys."""
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
