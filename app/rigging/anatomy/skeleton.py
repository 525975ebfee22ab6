"""The medial axis without its spurs: a body and its limbs, as paths of nodes."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from app.rigging.anatomy.medial_axis import MedialAxis
from engine.arrays import Floats, Indices

# A limb reaches out of the body by these parts of the body's half width at its root, and of the
# diameter. Corners of a square reach out by 0.41, those of a regular triangle by 1.
LEAST_REACH, LEAST_SHARE = 0.6, 0.05
# A node this many radii or more from the tip belongs to a sharp tip; the handle is at this share of
# the limb. In a round tip, the handle is at the first node whose discs further inwards, within so
# many radii, are hardly larger.
ROUND, SHARP = 1.5, 0.1
AHEAD, LEVEL = 0.6, 1.2
THIN = 0.25
# A cycle around a hole is pinched at a gate if within so many half widths of it both sides are so
# many times as wide.
PINCH_LENGTH, PINCH = 4.0, 1.6


class Branch(NamedTuple):
    """The nodes from an end of the axis up to its fork, and how far the end reaches out."""

    path: list[int]
    lengths: list[float]
    reach: float
    needed: float


class Skeleton:
    """The axis as a graph, while pinches and spurs are cut off.

    `diameter` is that of the shape.
    """

    def __init__(self, axis: MedialAxis, diameter: float) -> None:
        self.axis = axis
        self.diameter = diameter
        self.near: dict[int, set[int]] = {node: set() for node in range(len(axis.places))}
        for one, other in axis.links.tolist():
            self.near[one].add(other)
            self.near[other].add(one)

    def branch(self, end: int) -> Branch:
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
            # Without a fork, each end reaches out of the middle.
            at = int(np.searchsorted(lengths, lengths[-1] / 2))
        radius = float(self.axis.radii[path[at]])
        needed = max(LEAST_REACH * radius, LEAST_SHARE * self.diameter)
        return Branch(path, lengths, lengths[at] - radius, needed)

    def cut_spurs(self) -> dict[int, Branch]:
        """Cut off branches that hardly reach out, the least first; return the others by end."""
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

    def tip(self, branch: Branch) -> int:
        """Return the node for the handle of a branch's end: the middle of a round one."""
        radii, lengths = self.axis.radii[branch.path], np.array(branch.lengths)
        inwards = np.interp(lengths + AHEAD * radii, lengths, radii)
        is_sharp = lengths >= ROUND * radii
        is_tip = np.where(is_sharp, lengths >= SHARP * branch.reach, inwards <= LEVEL * radii)
        # A thin end of a thick limb, such as a thumb, does not get the handle.
        is_tip &= radii >= THIN * np.median(radii)
        return branch.path[int(is_tip.argmax())] if is_tip.any() else branch.path[-1]

    def cut_pinches(self) -> None:
        """Cut cycles around holes at pinches, where parts only touch, as two boots do."""
        places, radii, links, gates = self.axis
        on_ring = np.isin(links, self.ring_nodes()).all(axis=1)
        for link in sorted(np.flatnonzero(on_ring), key=lambda link: float(gates[link])):
            one, other = links[link].tolist()
            reach, least = PINCH_LENGTH * gates[link], PINCH * gates[link]
            if not (radii[np.abs(places - places[one]) <= reach] >= least).any():
                continue
            self.near[one].discard(other)
            self.near[other].discard(one)
            sides = [self.path_distances([end])[0] for end in (one, other)]
            is_pinched = all((radii[away <= reach] >= least).any() for away in sides)
            # A cycle that an earlier cut has opened is not cut again.
            if np.isinf(sides[0][other]) or not is_pinched:
                self.near[one].add(other)
                self.near[other].add(one)

    def open_rings(self, ground: float) -> None:
        """Cut all cycles around holes: between feet on the ground, else at their narrowest."""
        places, _, links, gates = self.axis
        heights = places.imag[links].mean(axis=1)
        order = np.lexsort((gates, np.where(heights <= ground, heights, np.inf)))
        while ring := set(self.ring_nodes()):
            for link in order.tolist():
                one, other = links[link].tolist()
                if not {one, other} <= ring or other not in self.near[one]:
                    continue
                self.near[one].discard(other)
                self.near[other].discard(one)
                if np.isfinite(self.path_distances([one])[0][other]):
                    break
                # The link connects two rings.
                self.near[one].add(other)
                self.near[other].add(one)

    def path_distances(self, starts: Iterable[int]) -> tuple[Floats, Indices]:
        """Return the path distance of nodes from the nearest start, inf if cut off or unconnected.

        For each node also the node before it on the path; negative if there is none.
        """
        links = [(node, other) for node, others in self.near.items() for other in others]
        rows, columns = np.array(links, dtype=np.intp).reshape(-1, 2).T
        places, count = self.axis.places, len(self.axis.places)
        lengths = np.maximum(np.abs(places[rows] - places[columns]), 1e-12)
        graph = coo_array((lengths, (rows, columns)), shape=(count, count)).tocsr()
        away, before, _ = dijkstra(
            graph, indices=list(starts), min_only=True, return_predecessors=True
        )
        return away, before.astype(np.intp)

    def ring_nodes(self) -> list[int]:
        """Return the nodes that lie on a cycle around a hole, or between two such cycles."""
        near = {node: set(others) for node, others in self.near.items()}
        ends = [node for node, others in near.items() if len(others) < 2]
        while ends:
            node = ends.pop()
            for other in near.pop(node):
                near[other].discard(node)
                if len(near[other]) == 1:
                    ends.append(other)
        return sorted(near)
