"""A fast direct solver of the integral equation, by recursive skeletonisation.

Nodes are grouped in boxes (`engine.dirichlet.partition`). A box and its exterior interact through
few functions, so some of the box's nodes (the skeleton) represent all:
A(box, outside) = U A(rows of the skeleton, outside), and likewise for columns. The other nodes are
eliminated. The skeletons of two halves form a box of the next level, and so on, until few nodes are
left (Martinsson and Rokhlin 2005). A circle around the box represents the far exterior. Time and
memory grow with the number of nodes, and faster where an outline fills an area: the larger a box
is, the more arms of the outline its cut crosses.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
import scipy.linalg
from scipy.sparse import csc_array

from engine.arrays import Floats, Indices, freeze, nbytes_of
from engine.dirichlet.boundary_operator import BoundaryOperator
from engine.dirichlet.panels import NODES
from engine.dirichlet.partition import partition_panels

LEAF = 6 * NODES  # nodes of a box of the lowest level, about
SMALL = 600  # nodes that are solved for directly
# Error of a skeleton relative to the interaction; random sums lose a digit more, corners another.
TOLERANCE = 5e-12
CIRCLE = 1.6  # radius of the circle around a box, over the box's own
ON_CIRCLE = 60  # points; their error falls like CIRCLE^−ON_CIRCLE
BLOCK = 2**18  # entries that are computed at a time, to stay in cache
SUMMED = 4  # number of random sums that include a row


class SkeletonBox(NamedTuple):
    """Nodes of a box, of which m are eliminated and r, the skeleton, are kept.

    Attributes
    ----------
    kept, others : intp, shapes (r,) and (m,)
        Indices among all nodes.
    weights : float64, shape (r, m)
        Weights of the skeleton in the interactions of the other nodes, in both directions.
    spread : float64, shape (r + m, m)
        From right-hand sides of the others to their additions to those of the skeleton, and to the
        others' solutions with a zero skeleton.
    follow : float64, shape (m, r)
        From solutions of the skeleton to their additions to the others' solutions.
    """

    kept: Indices
    others: Indices
    weights: Floats
    spread: Floats
    follow: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SkeletonSolver:
    """The factorised integral equation; build it with `SkeletonSolver.of`.

    Attributes
    ----------
    boxes : tuple of SkeletonBox
        In the order of elimination.
    rest : intp, shape (q,)
        The remaining nodes.
    top : float64, shape (q, q)
        The inverse of their matrix.
    roots : float64, shape (N,)
        Square roots of the nodes' weights.
    """

    boxes: tuple[SkeletonBox, ...]
    rest: Indices
    top: Floats
    roots: Floats

    @classmethod
    def of(
        cls, operator: BoundaryOperator, progress: Callable[[float], None] | None = None
    ) -> Self:
        """Compress and eliminate level by level; report the completed share before each box."""
        count = len(operator.panels)
        depth = max(0, round(np.log2(count * NODES / LEAF)))
        panels = np.arange(count * NODES).reshape(count, NODES)
        leaves = [panels[part].ravel() for part in partition_panels(operator.panels, depth)]
        active = [_Active(nodes, operator.entries(nodes, nodes)[0]) for nodes in leaves]
        boxes = []
        while len(active) > 1:
            if sum(len(each.nodes) for each in active) > SMALL:
                level, left = _Level(operator, active), np.log2(len(active))
                for number, each in enumerate(active):
                    if progress is not None:  # each level takes about as long
                        progress(1 - (left - number / len(active)) / depth)
                    box, active[number] = each.eliminated(level.sketch(each.nodes))
                    boxes.append(box)
            pairs = zip(active[::2], active[1::2], strict=True)
            active = [_Active.merged(operator, *pair) for pair in pairs]
        if progress is not None:
            progress(1.0)
        top: Floats = np.asarray(np.linalg.inv(active[0].block), dtype=np.float64)
        return cls(boxes=tuple(boxes), rest=active[0].nodes, top=freeze(top), roots=operator.roots)

    @property
    def nbytes(self) -> int:
        return nbytes_of(self)

    def __call__(self, right: Floats) -> Floats:
        """Return the solutions for right-hand sides (N, j)."""
        values = self.roots[:, None] * right
        for box in self.boxes:
            rank = len(box.kept)
            added = box.spread @ (values[box.others] - box.weights.T @ values[box.kept])
            values[box.kept] += added[:rank]
            values[box.others] = added[rank:]
        values[self.rest] = self.top @ values[self.rest]
        for box in reversed(self.boxes):
            others = values[box.others] + box.follow @ values[box.kept]
            values[box.kept] -= box.weights @ others
            values[box.others] = others
        return values / self.roots[:, None]


class _Active(NamedTuple):
    """A box during the elimination: its nodes, and the matrix between them."""

    nodes: Indices
    block: Floats

    @classmethod
    def merged(cls, operator: BoundaryOperator, first: "_Active", second: "_Active") -> Self:
        forward, backward = operator.entries(first.nodes, second.nodes)
        block = np.block([[first.block, forward], [backward.T, second.block]])
        return cls(np.concatenate([first.nodes, second.nodes]), block)

    def eliminated(self, sketch: Floats) -> tuple[SkeletonBox, "_Active"]:
        """Find the skeleton, and eliminate the other nodes.

        The pivots of an elimination of random sums give as good a skeleton as a QR decomposition,
        several times as fast (Dong and Martinsson 2023).
        """
        places, lower, upper = scipy.linalg.lu(sketch.T, p_indices=True, check_finite=False)
        order = np.argsort(places)
        # The remainder before each step: the diagonal alone may be small by chance.
        sizes = np.linalg.norm(upper, axis=1) / np.sqrt(np.arange(len(upper), 0, -1))
        rank = 1 + int(np.flatnonzero(sizes >= TOLERANCE * sizes.max())[-1])
        # The interactions of the other nodes are those of the skeleton times these weights.
        weights = scipy.linalg.solve_triangular(
            lower[:rank, :rank], lower[rank:, :rank].T, trans="T", lower=True, check_finite=False
        )
        block = self.block[order[:, None], order]
        inner, from_kept = block[:rank, :rank], block[rank:, :rank]
        # With x_kept = y_kept − weights y_others, and the same combinations of equations, the other
        # nodes do not interact with the exterior.
        to_kept = block[:rank, rank:] - inner @ weights
        rest = block[rank:, rank:] - from_kept @ weights - weights.T @ to_kept
        from_kept = from_kept - weights.T @ inner
        inverse = np.linalg.inv(rest)
        onto = to_kept @ inverse
        kept, others = self.nodes[order[:rank]], self.nodes[order[rank:]]
        box = SkeletonBox(
            kept=freeze(kept),
            others=freeze(others),
            weights=freeze(weights),
            spread=freeze(np.concatenate([-onto, inverse])),
            follow=freeze(-inverse @ from_kept),
        )
        return box, _Active(kept, inner - onto @ from_kept)


class _Level:
    """All boxes of one level, each with its surroundings."""

    def __init__(self, operator: BoundaryOperator, active: list[_Active]) -> None:
        self._operator = operator
        self._random = np.random.default_rng(0)
        self._box = np.full(len(operator.nodes), -1)  # of each node that is not eliminated
        for number, each in enumerate(active):
            self._box[each.nodes] = number

    def sketch(self, nodes: Indices) -> Floats:
        """Return as many random sums as columns of the box's interactions in both directions."""
        sums = np.zeros((len(nodes), len(nodes)))
        for rows in self._surroundings(nodes):
            # A sparse sign embedding: each row goes with a random sign into a few sums (Martinsson
            # and Tropp 2020, Section 9.2).
            count = SUMMED * len(rows)
            into = self._random.integers(len(sums), size=count)
            signs = 1.0 - 2.0 * self._random.integers(2, size=count)
            starts = np.arange(0, count + 1, SUMMED)
            mixing = csc_array((signs, into, starts), (len(sums), len(rows)))
            sums += np.asarray(mixing @ rows)
        return sums

    def _surroundings(self, nodes: Indices) -> Iterator[Floats]:
        """Yield a box's interactions with the exterior, both directions, in parts (a, n)."""
        operator, panels = self._operator, self._operator.panels
        middles, halves = panels.middles, np.abs(panels.span) / 2
        own = nodes // NODES
        low, high = middles[own].real.min(), middles[own].real.max()
        centre = complex(low + high, middles[own].imag.min() + middles[own].imag.max()) / 2
        radius = CIRCLE * float((np.abs(middles[own] - centre) + halves[own]).max())
        near = np.flatnonzero(np.abs(middles - centre) < radius + halves)
        around = (NODES * near[:, None] + np.arange(NODES)).ravel()
        box = self._box[around]
        around = around[(box >= 0) & (box != self._box[nodes[0]])]
        for start in range(0, len(around), max(1, BLOCK // len(nodes))):
            yield from operator.entries(around[start : start + max(1, BLOCK // len(nodes))], nodes)
        # A harmonic function inside the circle is that of charges on it; outside, its values on the
        # circle determine it.
        circle = centre + radius * np.exp(2j * np.pi * np.arange(ON_CIRCLE) / ON_CIRCLE)
        root = np.sqrt(radius / (2 * np.pi * ON_CIRCLE))
        kernel = root * operator.roots[nodes] / (operator.nodes[nodes] - circle[:, None])
        both = np.concatenate([kernel, kernel * operator.directions[nodes]])
        yield np.concatenate([both.real, both.imag])
        # A mean over a loop acts equally on all its nodes, and with these roots symmetrically.
        yield operator.means[:, nodes] / operator.roots[nodes]
