"""A fast direct solver of the integral equation, by recursive skeletonisation.

Nodes are taken in boxes of neighbours along the outline. Whatever is outside a box acts on it, and
is acted upon, through few functions, so that some of its nodes (the skeleton) stand for all:
A(box, outside) = U A(rows of the skeleton, outside), and likewise for columns. With the other nodes
eliminated, the skeletons of two neighbours form a box of the next level, and so on, until the
rest is small (Martinsson and Rokhlin 2005). What is far outside is represented by a circle around
the box. Time and memory grow with the number of nodes.
"""

from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Self

import numpy as np
import scipy.linalg
from scipy.sparse import csc_array

from engine.arrays import Floats, Indices, freeze
from engine.dirichlet.boundary_operator import BoundaryOperator
from engine.dirichlet.panels import NODES

LEAF = 6 * NODES  # nodes of a box of the lowest level, about
SMALL = 600  # nodes that are solved for directly
# Of what a skeleton loses, relative to what acts; random sums lose a digit more, corners another.
TOLERANCE = 1e-11
CIRCLE = 2.0  # radius of the circle around a box, over the box's own
SUMMED, SPARE = 6, 32  # random sums into which a row goes; sums beyond the number of columns
ON_CIRCLE = 64  # points; what they miss falls like CIRCLE^(−half of them)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SkeletonBox:
    """Nodes of one level that are eliminated but for their skeleton; n of them, r in the skeleton.

    Parameters
    ----------
    first : int
        The first of its rows among those of its level.
    reduce : float64, shape (r, n)
        From right-hand sides to those of the next level.
    expand : float64, shape (n, r)
        From solutions of the next level to these.
    local : float64, shape (n, n)
        What a right-hand side does to the solution without the next level.
    """

    first: int
    reduce: Floats
    expand: Floats
    local: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SkeletonSolver:
    """The factorised integral equation; build it with `SkeletonSolver.of`.

    Parameters
    ----------
    levels : tuple of tuple of SkeletonBox
        From the lowest level up.
    top : float64, shape (m, m)
        The inverse of what is left.
    roots : float64, shape (N,)
        Of the nodes' weights.
    """

    levels: tuple[tuple[SkeletonBox, ...], ...]
    top: Floats
    roots: Floats

    @classmethod
    def of(cls, operator: BoundaryOperator) -> Self:
        """Compress and eliminate level by level."""
        size = len(operator.nodes)
        system = _System(operator=operator, roots=np.sqrt(np.abs(operator.differentials)))
        # A box of nodes on two loops would be a large one.
        cuts = [0]
        for start, end in pairwise([*operator.starts, size]):
            count = max(1, round((end - start) / LEAF))
            along = np.linspace(0, (end - start) // NODES, count + 1).astype(int)
            cuts += (start + NODES * along[1:]).tolist()
        active = [_Active.leaf(system, np.arange(a, b)) for a, b in pairwise(cuts)]
        levels = []
        while len(active) > 1 and sum(len(each.nodes) for each in active) > SMALL:
            boxes, skeletons, first = [], [], 0
            for index, each in enumerate(active):
                others = active[:index] + active[index + 1 :]
                box, skeleton = each.eliminated(system.surroundings(each, others), first)
                boxes.append(box)
                skeletons.append(skeleton)
                first += len(each.nodes)
            levels.append(tuple(boxes))
            active = [
                _Active.merged(system, skeletons[i : i + 2]) for i in range(0, len(skeletons), 2)
            ]
        whole = _Active.merged(system, active)
        top: Floats = np.asarray(np.linalg.inv(whole.block), dtype=np.float64)
        return cls(levels=tuple(levels), top=freeze(top), roots=freeze(system.roots))

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        boxes = [box for level in self.levels for box in level]
        arrays = [array for b in boxes for array in (b.reduce, b.expand, b.local)]
        return self.top.nbytes + self.roots.nbytes + sum(array.nbytes for array in arrays)

    def __call__(self, right: Floats) -> Floats:
        """Return the solutions for right-hand sides (N, j)."""
        sides = [self.roots[:, None] * right]
        for level in self.levels:
            given = sides[-1]
            sides.append(
                np.concatenate(
                    [box.reduce @ given[box.first : box.first + len(box.local)] for box in level]
                )
            )
        solution: Floats = self.top @ sides.pop()
        for level in reversed(self.levels):
            given, found, place = sides.pop(), [], 0
            for box in level:
                own = given[box.first : box.first + len(box.local)]
                rank = len(box.reduce)
                found.append(box.local @ own + box.expand @ solution[place : place + rank])
                place += rank
            solution = np.concatenate(found)
        return solution / self.roots[:, None]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Active:
    """A box under work: its nodes, and the matrix between them."""

    nodes: Indices
    block: Floats

    @classmethod
    def leaf(cls, system: "_System", nodes: Indices) -> Self:
        return cls(nodes=nodes, block=system.entries(nodes, nodes))

    @classmethod
    def merged(cls, system: "_System", parts: list["_Active"]) -> Self:
        blocks = [
            [a.block if a is b else system.entries(a.nodes, b.nodes) for b in parts] for a in parts
        ]
        return cls(nodes=np.concatenate([part.nodes for part in parts]), block=np.block(blocks))

    def eliminated(self, surroundings: Floats, first: int) -> tuple[SkeletonBox, "_Active"]:
        """Find the skeleton, and eliminate the other nodes."""
        triangle, order = scipy.linalg.qr(
            _sketched(surroundings), mode="r", pivoting=True, overwrite_a=True, check_finite=False
        )
        sizes = np.abs(np.diagonal(triangle))
        rank = max(1, int(np.count_nonzero(sizes > TOLERANCE * sizes[0])))
        # What acts on the others, and what they act on, is that of the skeleton times these.
        weights = scipy.linalg.solve_triangular(
            triangle[:rank, :rank], triangle[:rank, rank:], check_finite=False
        ).astype(np.float64, copy=False)
        kept, others = order[:rank], order[rank:]
        block = self.block[order[:, None], order]
        inner, to_kept = block[:rank, :rank], block[:rank, rank:]
        from_kept = block[rank:, :rank]
        # With x_kept = y_kept − weights y_others, and the same combinations of equations, nothing
        # outside acts on the others, nor they on it.
        to_kept = to_kept - inner @ weights
        rest = block[rank:, rank:] - from_kept @ weights - weights.T @ to_kept
        from_kept = from_kept - weights.T @ inner
        inverse = np.linalg.inv(rest)
        size = len(block)
        change = np.zeros((len(others), size))  # from right-hand sides to y_others
        change[:, others], change[:, kept] = inverse, -inverse @ weights.T
        reduce = -to_kept @ change
        reduce[:, kept] += np.eye(rank)
        follow = -inverse @ from_kept  # from y_kept to y_others
        expand, local = np.empty((size, rank)), np.empty((size, size))
        expand[others], expand[kept] = follow, np.eye(rank) - weights @ follow
        local[others], local[kept] = change, -weights @ change
        box = SkeletonBox(
            first=first, reduce=freeze(reduce), expand=freeze(expand), local=freeze(local)
        )
        return box, _Active(nodes=self.nodes[kept], block=inner + to_kept @ follow)


def _sketched(rows: Floats) -> Floats:
    """Return few random sums of many rows: their columns depend on each other as before.

    Each row goes with a random sign into a few sums, of which there are hardly more than columns
    (a sparse sign embedding; Martinsson and Tropp 2020, Section 9.2).
    """
    count, columns = rows.shape
    sums = columns + SPARE
    if count <= sums:
        return rows
    entries = count * SUMMED
    numbers, signs = _random(entries.bit_length())
    into, signs = numbers[:entries] % sums, signs[:entries]
    sketch = csc_array((signs, into, np.arange(0, entries + 1, SUMMED)), (sums, count))
    sketched: Floats = np.asarray(sketch @ rows)
    return sketched


@cache
def _random(bits: int) -> tuple[Indices, Floats]:
    """Return 2^bits large random numbers and as many signs."""
    numbers = np.random.default_rng(0).integers(2**62, size=2**bits)
    return freeze(numbers >> 1), freeze(1.0 - 2.0 * (numbers & 1))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _System:
    """The operator on unknowns times the roots of their weights, so that it is nearly symmetric."""

    operator: BoundaryOperator
    roots: Floats

    def entries(self, rows: Indices, columns: Indices) -> Floats:
        entries = self.operator.entries(rows, columns)
        entries *= self.roots[rows, None]
        entries /= self.roots[columns]
        return entries

    def surroundings(self, box: _Active, others: list[_Active]) -> Floats:
        """Return what acts on a box from outside and what it acts on, (a, n)."""
        operator, nodes = self.operator, self.operator.nodes
        here = nodes[box.nodes]
        low = complex(here.real.min(), here.imag.min())
        high = complex(here.real.max(), here.imag.max())
        centre = (low + high) / 2
        radius = CIRCLE * float(np.abs(here - centre).max())
        outside = np.concatenate([other.nodes for other in others])
        is_near = np.abs(nodes - centre) < radius
        near_rows, near_columns = is_near.copy(), is_near
        near_rows[operator.near_rows(box.nodes)] = True
        near_columns[operator.near_columns(box.nodes)] = True
        near_by = self.entries(outside[near_rows[outside]], box.nodes)
        near_from = self.entries(box.nodes, outside[near_columns[outside]])
        # A harmonic function inside the circle is one of charges on it, and outside it one of its
        # values there.
        circle = centre + radius * np.exp(2j * np.pi * np.arange(ON_CIRCLE) / ON_CIRCLE)
        root = np.sqrt(radius / (2 * np.pi * ON_CIRCLE))
        kernel = root * self.roots[box.nodes] / (here - circle[:, None])
        turn = operator.differentials[box.nodes] / np.abs(operator.differentials[box.nodes])
        # Means over loops act on all nodes of the loop alike, and with these roots symmetrically.
        means = operator.means[:, box.nodes] / self.roots[box.nodes]
        return np.concatenate(
            [near_by, near_from.T, kernel.real, kernel.imag, (kernel * turn).imag, means]
        )
