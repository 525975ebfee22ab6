"""The matrix of the integral equation, entry by entry.

Row i is the equation at node i, μ/2 + 1/(2π) ∮ μ Im(dζ / (ζ − z)) = b: plain quadrature far from a
panel, and exact integrals of its polynomials near it.

On the loop of a hole the mean of μ there is added. Constants there, which the integral does not
see, are ruled out by it, and what the mean is in the end is what the real part lacks: a function
that is to be the real part of a single-valued one may have to give way by a constant around each
hole (S. Mikhlin, *Integral Equations*, 1957, section 31).
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from engine.arrays import Complexes, Floats, Indices, ragged
from engine.dirichlet.panels import NODES, Panels
from engine.dirichlet.product_integration import is_near, near_distance, panel_weights
from engine.geometry import as_xy


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BoundaryOperator:
    """The collocated operator of some panels.

    Parameters
    ----------
    nodes, differentials : complex128, shape (N,)
    near : csr_array, float64, shape (N, N)
        Entries of panels at the nodes near them, zeros among them.
    near_by_column : csr_array, float64, shape (N, N)
        The transpose.
    starts : intp, shape (1 + holes,)
        The first node of each loop.
    means : float64, shape (holes, N)
        The weights of the mean over the loop of each hole.
    """

    nodes: Complexes
    differentials: Complexes
    near: csr_array
    near_by_column: csr_array
    starts: Indices
    means: Floats

    @classmethod
    def of(cls, panels: Panels) -> Self:
        """Integrate the panels exactly at the nodes near them."""
        nodes = panels.nodes.ravel()
        size = len(nodes)
        rows, values = [], []
        for power in np.unique(panels.power):
            each = _near_entries(panels, nodes, int(power))
            rows.append(each[0])
            values.append(each[1])
        pairs, entries = np.concatenate(rows), np.concatenate(values)
        # On a straight panel the kernel of a node of the same panel vanishes, but for the jump.
        own = np.repeat(np.eye(NODES)[None] * np.pi, len(panels), axis=0).reshape(size, NODES)
        pairs = np.concatenate(
            [pairs, np.column_stack([np.arange(size), np.arange(size) // NODES])]
        )
        entries = np.concatenate([entries, own])
        columns = pairs[:, 1:] * NODES + np.arange(NODES)
        row = np.repeat(pairs[:, 0], NODES)
        entries /= 2 * np.pi
        near = csr_array((entries.ravel(), (row, columns.ravel())), shape=(size, size))
        differentials = panels.differentials().ravel()
        firsts = NODES * panels.starts
        means = np.zeros((len(firsts) - 1, size))
        for number, (start, end) in enumerate(pairwise([*firsts[1:], size])):
            lengths = np.abs(differentials[start:end])
            means[number, start:end] = lengths / lengths.sum()
        return cls(
            nodes=nodes,
            differentials=differentials,
            near=near,
            near_by_column=near.T.tocsr(),
            starts=firsts,
            means=means,
        )

    def near_rows(self, columns: Indices) -> Indices:
        """Return the nodes at which some columns are integrated exactly, some more than once."""
        return _chosen(self.near_by_column, columns)[2]

    def near_columns(self, rows: Indices) -> Indices:
        """Return the columns that are integrated exactly at some nodes, some more than once."""
        return _chosen(self.near, rows)[2]

    def entries(self, rows: Indices, columns: Indices) -> Floats:
        """Return a part of the matrix (r, c)."""
        # The plain kernel, Im dζ / (ζ − z), without complex numbers.
        to, of = self.nodes[rows, None], self.nodes[columns]
        x, y = of.real - to.real, of.imag - to.imag
        weights = self.differentials[columns] / (2 * np.pi)
        found: Floats = weights.imag * x
        spare = weights.real * y
        found -= spare
        x *= x
        x += np.multiply(y, y, out=spare)
        with np.errstate(divide="ignore", invalid="ignore"):
            found /= x
        place = np.full(len(self.nodes), -1)
        place[columns] = np.arange(len(columns))
        row, entry, column = _chosen(self.near, rows)
        column = place[column]
        there = column >= 0
        found[row[there], column[there]] = self.near.data[entry[there]]
        for mean in self.means:
            found += (mean[rows, None] > 0) * mean[columns]
        return found


def _chosen(matrix: csr_array, rows: Indices) -> tuple[Indices, Indices, Indices]:
    """Return the entries of some rows: in which of these, their numbers, and their columns."""
    starts = matrix.indptr[rows]
    row, place = ragged(matrix.indptr[rows + 1] - starts)
    entry = starts[row] + place
    return row, entry, matrix.indices[entry]


def _near_entries(panels: Panels, nodes: Complexes, power: int) -> tuple[Indices, Floats]:
    """Return the pairs (t, 2) of nodes and near panels of a power, and the entries (t, NODES)."""
    own = np.flatnonzero(panels.power == power)
    length = np.abs(panels.span[own])
    around = (0.5 + near_distance(panels.power[own])) * length
    middles = panels.origin[own] + panels.span[own] / 2
    found = cKDTree(as_xy(nodes)).query_ball_point(as_xy(middles), around)
    panel = np.repeat(own, [len(each) for each in found])
    node = np.concatenate([np.asarray(each, dtype=np.intp) for each in found])
    panel, node = panel[node // NODES != panel], node[node // NODES != panel]
    w = (nodes[node] - panels.origin[panel]) / panels.span[panel]
    if power != 1:
        # Across a corner both panels start there, and nodes as close to it as 1e-10 of a panel keep
        # all their digits only if the corner is never added and subtracted.
        across = np.where(panels.forward[panel], panels.before[panel], panels.following[panel])
        beside = node // NODES == across
        arcs = panels.arcs().ravel()[node[beside]]
        w[beside] = arcs * (panels.span[across[beside]] / panels.span[panel[beside]])
    near = is_near(w, power)
    sign = np.where(panels.forward[panel[near]], 1.0, -1.0)
    entries: Floats = sign[:, None] * panel_weights(w[near], power)[0].imag
    return np.column_stack([node[near], panel[near]]), entries
