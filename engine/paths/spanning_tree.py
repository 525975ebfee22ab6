"""Spanning trees of graphs, and sums along their paths (Section 7).

Nodes are numbered in depth-first order, so neighbours on a path are neighbours in memory. The sum
from the root to every node is one cumulative sum along the Euler tour. The tour passes each edge
once downwards with its value, and once upwards with the opposite value.
"""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order, depth_first_order

from engine.arrays import Complexes, Floats, Indices, freeze

type_ = TypeVar("type_", Complexes, Floats)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpanningTree:
    """A tree whose nodes are numbered in depth-first order; the root is node 0.

    `parent` (s,) is the parent of each node; the root is its own parent. `down` and `up` (s,) are
    the steps of the Euler tour that pass the edge from the parent.
    """

    parent: Indices
    down: Indices
    up: Indices

    @classmethod
    def of_parents(cls, parent: Indices) -> "SpanningTree":
        """Build the tour from the parents of nodes in depth-first order."""
        depth = _depths(parent)
        down = 2 * np.arange(len(parent)) - depth
        up = down + 2 * _subtree_sizes(parent, depth) - 1
        return cls(parent=freeze(parent), down=freeze(down), up=freeze(up))

    def sums(self, steps: type_) -> type_:
        """Return for each node the sum of `steps` (s,) over its path from the root.

        `steps` holds the value of each node's edge from its parent; the root has its start value.
        """
        tour = np.zeros(2 * len(steps), dtype=steps.dtype)
        tour[self.down] = steps
        tour[self.up] = -steps
        np.cumsum(tour, out=tour)
        return tour[self.down]


def breadth_first_parents(count: int, edges: Indices, root: int) -> Indices:
    """Return `shortest_parents` of a graph with `count` nodes and undirected edges (e, 2)."""
    graph = csr_array((np.ones(len(edges), dtype=np.int8), edges.T), shape=(count, count))
    return shortest_parents(graph + graph.T, root)


def shortest_parents(graph: csr_array, root: int) -> Indices:
    """Return each node's parent (n,) on the path with the fewest edges from the root.

    The root is its own parent; −1 without a path. The graph is a symmetric matrix (n, n).
    """
    order, predecessors = breadth_first_order(graph, root)
    parents = np.full(graph.shape[0], -1, dtype=np.intp)
    parents[order] = predecessors[order]
    parents[root] = root
    return parents


def depth_first_numbering(parents: Indices, root: int) -> Indices:
    """Return the nodes (s,) of a tree in depth-first order from the root.

    Nodes with the parent −1 are left out.
    """
    children = np.flatnonzero(parents >= 0)
    children = children[children != root]
    ones = np.ones(len(children), dtype=np.int8)
    size = len(parents)
    tree = csr_array((ones, (parents[children], children)), shape=(size, size))
    return np.asarray(depth_first_order(tree, root, return_predecessors=False), dtype=np.intp)


def _depths(parent: Indices) -> Indices:
    """Count the edges from the root by pointer doubling: round r reaches 2^r ancestors."""
    depth: Indices = (np.arange(len(parent)) != parent).astype(np.intp)
    ancestor = parent
    while ancestor.any():
        depth = depth + depth[ancestor]
        ancestor = ancestor[ancestor]
    return depth


def _subtree_sizes(parent: Indices, depth: Indices) -> Indices:
    """Count the nodes of each node's subtree, itself included, from the deepest level upwards."""
    sizes = np.ones(len(parent), dtype=np.intp)
    by_depth = np.argsort(depth, kind="stable")
    starts = np.searchsorted(depth[by_depth], np.arange(1, depth.max(initial=0) + 2))
    for level in range(len(starts) - 2, -1, -1):
        nodes = by_depth[starts[level] : starts[level + 1]]
        np.add.at(sizes, parent[nodes], sizes[nodes])
    return sizes
