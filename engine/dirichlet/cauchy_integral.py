"""Cauchy integrals of densities on panels, evaluated at many points up to the outline itself.

What panels far from a point contribute comes through expansions: moments of the densities about
the centres of clusters, Taylor polynomials about those of squares. Panels near a point are
integrated exactly. Which is which, and the weights of the latter, depend on the panels and the
points alone and are worked out once; time and memory grow with the sum of points and nodes, not
with their product.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Self

import numpy as np
from scipy.sparse import bsr_array
from scipy.special import comb

from engine.arrays import Complexes, Floats, Indices, freeze, ragged
from engine.dirichlet.interactions import Interactions, interactions
from engine.dirichlet.near_field import near_matrix
from engine.dirichlet.panels import NODES, Panels

TERMS = 18  # of expansions: they err by FAR^-TERMS = 7e-8 of the largest density at most
BLOCK = 256  # pairs whose expansions are translated at a time, so that they stay in cache


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CauchyIntegral:
    """g(z) = 1/(2πi) ∮ μ dζ / (ζ − z) and g'(z) at fixed points, for any densities.

    Build it with `CauchyIntegral.of`.

    Parameters
    ----------
    panels : Panels
    acting : Interactions
    near : bsr_array, float64, shape (4 t, N)
        From densities to what near panels add to Re g, Im g, Re g' and Im g' at the points in the
        order of the squares.
    offsets : complex128, shape (t,)
        Of the points in that order from the centres of their leaves, over the radius.
    """

    panels: Panels
    acting: Interactions
    near: bsr_array
    offsets: Complexes

    @classmethod
    def of(cls, panels: Panels, points: Complexes) -> Self:
        """Prepare the integrals at points (t,).

        They lie strictly inside the outline, by some 1e-14 of its size at least.
        """
        acting = interactions(panels, points)
        squares, near = acting.squares, acting.near
        leaf, _ = ragged(squares.ends[squares.leaves] - squares.starts[squares.leaves])
        leaf = squares.leaves[leaf]
        z = points[squares.order]
        count = len(panels)
        keys = near.squares * count + near.clusters
        alone = np.array(
            [
                ~np.isin(near.squares * count + beside[near.clusters], keys)
                for beside in (panels.before, panels.following)
            ]
        )
        # The near pairs of a leaf belong to each of its points.
        first = np.searchsorted(near.squares, leaf)
        rows, place = ragged(np.searchsorted(near.squares, leaf, side="right") - first)
        own = first[rows] + place
        return cls(
            panels=panels,
            acting=acting,
            near=near_matrix(panels, z, rows, near.clusters[own], alone[:, own]),
            offsets=freeze((z - squares.centre[leaf]) / squares.radius[leaf]),
        )

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        near = self.near
        own = near.data.nbytes + near.indices.nbytes + near.indptr.nbytes + self.offsets.nbytes
        return int(own) + self.acting.nbytes

    def __call__(self, densities: Floats) -> tuple[Complexes, Complexes]:
        """Return g and g' of some densities.

        Parameters
        ----------
        densities : float64, shape (N, j)
            At the nodes of the panels.

        Returns
        -------
        values, derivatives : complex128, shape (t, j)
        """
        squares, columns = self.acting.squares, densities.shape[1]
        near = (self.near @ densities).reshape(len(self.offsets), 2, 2, columns)
        results = np.empty((2, columns, len(self.offsets)), dtype=np.complex128)
        polynomials = self._taylor(densities)
        ranks = np.arange(1.0, TERMS)[:, None]
        slopes = np.zeros_like(polynomials)
        slopes[:, :-1] = polynomials[:, 1:] * ranks / squares.radius[squares.leaves, None, None]
        both = np.concatenate([polynomials, slopes], axis=2)
        starts, ends = squares.starts[squares.leaves], squares.ends[squares.leaves]
        for first in range(0, len(starts), BLOCK):
            last = min(first + BLOCK, len(starts)) - 1
            block = slice(starts[first], ends[last])
            powers = _powers(self.offsets[block])
            found = near[block, :, 0] + 1j * near[block, :, 1]
            flat = found.reshape(-1, 2 * columns)
            for leaf in range(first, last + 1):
                own = slice(starts[leaf] - block.start, ends[leaf] - block.start)
                flat[own] += powers[:, own].T @ both[leaf]
            results[:, :, squares.order[block]] = found.transpose(1, 2, 0)
        return results[0].T, results[1].T

    def _taylor(self, densities: Floats) -> Complexes:
        """Return the polynomials (l, TERMS, j) of the leaves."""
        squares, clusters, far, direct, _ = self.acting
        columns = densities.shape[1]
        by_panel = densities.reshape(len(self.panels), NODES, columns)
        differentials = self.panels.differentials() / (2j * np.pi)
        masses = by_panel * differentials[:, :, None]
        moments = self._moments(by_panel, differentials)
        taylor = np.zeros((TERMS, len(squares.centre), columns), dtype=np.complex128)
        for block, targets, starts in _blocks(far.squares):
            # 1 / (ζ − z) = Σ binom(i + k, k) (z − c_T)^i (c_S − ζ)^k / (c_S − c_T)^(i + k + 1).
            source, target = far.clusters[block], far.squares[block]
            inverse = 1.0 / (clusters.centre[source] - squares.centre[target])
            scaled = moments[:, source] * _powers(clusters.radius[source] * inverse)[:, :, None]
            into = scaled.reshape(TERMS, -1).view(np.float64)
            parts = (_translation() @ into).view(np.complex128).reshape(scaled.shape)
            parts *= (_powers(squares.radius[target] * inverse) * inverse)[:, :, None]
            taylor[:, targets] += np.add.reduceat(parts, starts, axis=1)
        nodes = self.panels.nodes
        for block, targets, starts in _blocks(direct.squares):
            panel, target = direct.clusters[block], direct.squares[block]
            inverse = 1.0 / (nodes[panel] - squares.centre[target, None])
            powers = _powers(squares.radius[target, None] * inverse) * inverse
            parts = np.matmul(powers.transpose(1, 0, 2), masses[panel])
            taylor[:, targets] += np.add.reduceat(parts, starts).transpose(1, 0, 2)
        for level in squares.levels[1:]:
            for quadrant, matrix in enumerate(_to_quarters()):
                own = level.start + np.flatnonzero(squares.quadrant[level] == quadrant)
                given = taylor[:, squares.parent[own]]
                taylor[:, own] += (matrix @ given.reshape(TERMS, -1)).reshape(given.shape)
        return np.ascontiguousarray(taylor[:, squares.leaves].transpose(1, 0, 2))

    def _moments(self, densities: Floats, differentials: Complexes) -> Complexes:
        """Return Σ m ((c − ζ) / r)^k of the clusters, (TERMS, c, j)."""
        clusters, nodes = self.acting.clusters, self.panels.nodes
        count, _, columns = densities.shape
        moments = np.empty((TERMS, len(clusters.centre), columns), dtype=np.complex128)
        for level, (first, end) in enumerate(pairwise(clusters.firsts)):
            of_panel = first + (np.arange(count) >> level)
            away = clusters.centre[of_panel, None] - nodes
            weights = _powers(away / clusters.radius[of_panel, None]) * differentials
            # The panels of a cluster side by side; the last one may have fewer.
            lacking = ((end - first) << level) - count
            padded = np.pad(densities, ((0, lacking), (0, 0), (0, 0)))
            given = padded.reshape(end - first, -1, columns)
            own = moments[:, first:end].transpose(1, 0, 2)
            for part, into in ((weights.real, own.real), (weights.imag, own.imag)):
                by_panel = np.pad(part, ((0, 0), (0, lacking), (0, 0)))
                into[:] = by_panel.reshape(TERMS, end - first, -1).transpose(1, 0, 2) @ given
        return moments


def _powers(base: Complexes) -> Complexes:
    """Return base^k for k < TERMS, (TERMS, ...)."""
    powers = np.empty((TERMS, *base.shape), dtype=np.complex128)
    powers[0] = 1.0
    for k in range(1, TERMS):
        np.multiply(powers[k - 1], base, out=powers[k])
    return powers


def _blocks(targets: Indices) -> Iterator[tuple[slice, Indices, Indices]]:
    """Yield blocks of sorted pairs, their targets once each, and where the pairs of each start."""
    for first in range(0, len(targets), BLOCK):
        own = targets[first : first + BLOCK]
        starts = np.flatnonzero(np.diff(own, prepend=-1))
        yield slice(first, first + BLOCK), own[starts], starts


@cache
def _translation() -> Floats:
    """Return binom(i + k, k), what the moment k adds to the power i."""
    ranks = np.arange(TERMS)
    return freeze(comb(ranks[:, None] + ranks, ranks).astype(np.float64))


@cache
def _to_quarters() -> Complexes:
    """Return the matrices (4, TERMS, TERMS) from the polynomial of a square to its quarters'."""
    ranks = np.arange(TERMS)
    raised = np.maximum(ranks - ranks[:, None], 0)
    # Of Σ c_k ((z − c) / r)^k, with half the radius about a centre that is off by half a side.
    shifts = np.array([-1 - 1j, 1 - 1j, -1 + 1j, 1 + 1j]) / np.sqrt(8)
    binomials = comb(ranks, ranks[:, None])
    matrices = binomials * shifts[:, None, None] ** raised * 0.5 ** ranks[:, None]
    return freeze(np.asarray(matrices, dtype=np.complex128))
