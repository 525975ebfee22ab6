"""The matrix of the integral equation, entry by entry.

Row i is the equation at node i, μ/2 + 1/(2π) ∮ μ Im(dζ / (ζ − z)) = b. Far from a panel it uses
plain quadrature, near a panel exact integrals of the panel's polynomials. Both sides and μ are
multiplied by the square roots of the nodes' weights, so the matrix is nearly symmetric.

On the loop of a hole the mean of μ there is added. Without it a constant μ on the loop solves the
homogeneous equation; the mean makes the solution unique. The mean of the solution is the error of
the real part: around a hole, a single-valued function attains its real part only up to a constant
(S. Mikhlin, *Integral Equations*, 1957, section 31).
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from engine.arrays import Complexes, Floats, Indices, ragged_indices
from engine.dirichlet.panels import NODES, Panels
from engine.dirichlet.product_integration import is_near, near_distance, panel_weights
from engine.geometry import as_xy


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BoundaryOperator:
    """The collocated operator of some panels.

    Attributes
    ----------
    nodes, directions : complex128, shape (N,)
        The nodes, and the unit tangents dζ / |dζ| there.
    roots : float64, shape (N,)
        Square roots of the nodes' weights.
    near : csr_array, float64, shape (N, N)
        Entries of panels at the nodes near them, including zeros.
    near_by_column : csr_array, float64, shape (N, N)
        The transpose.
    means : float64, shape (holes, N)
        The weights of the mean over the loop of each hole.
    """

    panels: Panels
    nodes: Complexes
    directions: Complexes
    roots: Floats
    near: csr_array
    near_by_column: csr_array
    means: Floats

    @classmethod
    def of(cls, panels: Panels) -> Self:
        """Integrate the panels exactly at the nodes near them."""
        nodes, differentials = panels.nodes.ravel(), panels.differentials().ravel()
        size = len(nodes)
        lengths = np.abs(differentials)
        roots = np.sqrt(lengths)
        rows, values = [], []
        for power in np.unique(panels.power):
            each = _near_entries(panels, nodes, int(power))
            rows.append(each[0])
            values.append(each[1])
        # Within a straight panel the kernel vanishes but for the jump.
        rows.append(np.column_stack([np.arange(size), np.arange(size) // NODES]))
        values.append(np.tile(np.pi * np.eye(NODES), (len(panels), 1)))
        pairs, entries = np.concatenate(rows), np.concatenate(values) / (2 * np.pi)
        row, column = pairs[:, :1], pairs[:, 1:] * NODES + np.arange(NODES)
        entries *= roots[row] / roots[column]
        row = np.broadcast_to(row, column.shape)
        near = csr_array((entries.ravel(), (row.ravel(), column.ravel())), shape=(size, size))
        firsts = NODES * panels.starts
        means = np.zeros((len(firsts) - 1, size))
        for number, (start, end) in enumerate(pairwise([*firsts[1:], size])):
            means[number, start:end] = lengths[start:end] / lengths[start:end].sum()
        return cls(
            panels=panels,
            nodes=nodes,
            directions=differentials / lengths,
            roots=roots,
            near=near,
            near_by_column=near.T.tocsr(),
            means=means,
        )

    def entries(self, rows: Indices, columns: Indices) -> tuple[Floats, Floats]:
        """Return a part of the matrix, and the same part of its transpose, (r, c) each.

        The second part maps the rows' nodes to the columns' nodes.
        """
        # Im dζ / (ζ − z) and, from the other end, Im dz / (z − ζ), without complex numbers.
        to, of = self.nodes[rows, None], self.nodes[columns]
        x, y = of.real - to.real, of.imag - to.imag
        scale = x * x
        scale += y * y
        with np.errstate(divide="ignore", invalid="ignore"):
            np.divide(self.roots[columns] / (2 * np.pi), scale, out=scale)
            scale *= self.roots[rows, None]
            x *= scale
            y *= scale
        forward, backward = self.directions[columns], self.directions[rows, None]
        found = forward.imag * x - forward.real * y, backward.real * y - backward.imag * x
        place = np.full(len(self.nodes), -1)
        place[rows] = np.arange(len(rows))
        for near, into in zip((self.near_by_column, self.near), found, strict=True):
            starts = near.indptr[columns]
            column, entry = ragged_indices(near.indptr[columns + 1] - starts)
            entry += starts[column]
            row = place[near.indices[entry]]
            there = row >= 0
            into[row[there], column[there]] = near.data[entry[there]]
            if len(self.means):
                # As symmetric as the rest, since the means' weights are squares of the roots.
                own, others = self.means[:, rows] / self.roots[rows], self.means[:, columns] > 0
                np.add(into, own.T @ (others * self.roots[columns]), out=into)
        return found


def _near_entries(panels: Panels, nodes: Complexes, power: int) -> tuple[Indices, Floats]:
    """Return the pairs (t, 2) of nodes and near panels of a power, and the entries (t, NODES)."""
    own = np.flatnonzero(panels.power == power)
    length = np.abs(panels.span[own])
    around = (0.5 + near_distance(panels.power[own])) * length
    found = cKDTree(as_xy(nodes)).query_ball_point(as_xy(panels.middles[own]), around)
    panel = np.repeat(own, [len(each) for each in found])
    node = np.concatenate([np.asarray(each, dtype=np.intp) for each in found])
    panel, node = panel[node // NODES != panel], node[node // NODES != panel]
    w = (nodes[node] - panels.origin[panel]) / panels.span[panel]
    if power != 1:
        # Across a corner both panels start at the corner. Nodes as close to it as 1e-10 of a panel
        # keep all their digits only if the corner is never added and subtracted.
        across = np.where(
            panels.forward[panel], panels.previous_panels[panel], panels.next_panels[panel]
        )
        beside = node // NODES == across
        arcs = panels.arcs().ravel()[node[beside]]
        w[beside] = arcs * (panels.span[across[beside]] / panels.span[panel[beside]])
    near = is_near(w, power)
    sign = np.where(panels.forward[panel[near]], 1.0, -1.0)
    entries: Floats = sign[:, None] * panel_weights(w[near], power)[0].imag
    return np.column_stack([node[near], panel[near]]), entries
