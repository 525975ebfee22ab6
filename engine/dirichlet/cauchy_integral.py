"""Cauchy integrals of densities on panels, evaluated at many points up to the outline itself.

Panels far from a point contribute through expansions (`engine.dirichlet.expansions`). Panels near a
point are integrated exactly. The lists of both, and their weights, depend on the panels and the
points only and are computed once. Time and memory grow with the sum of points and nodes, not with
their product.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np
from scipy.sparse import bsr_array

from engine.arrays import Complexes, Floats, Indices, freeze, ragged_indices
from engine.dirichlet.expansions import TERMS, AnyComplexes, Expansions, powers
from engine.dirichlet.interactions import find_interactions
from engine.dirichlet.near_field import near_matrices, near_matrix
from engine.dirichlet.panels import Panels

BLOCK = 2048  # points whose results are combined at a time, to stay in cache


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CauchyIntegral:
    """g(z) = 1/(2πi) ∮ μ dζ / (ζ − z) and g'(z) at fixed points, for any densities.

    Build it with `CauchyIntegral.of`.

    Attributes
    ----------
    near : tuple of bsr_array, shape (4 t, N)
        From densities to the near panels' part of Re g, Im g, Re g' and Im g' at the points, in the
        order of the leaves. The matrices are added.
    leaves, counts : intp, shape (l,)
        Uncut squares in ascending order, and the number of points in each.
    offsets : complex, shape (t,)
        Positions of the points in this order relative to the centres of their leaves, over the
        radius.
    places : intp, shape (t,)
        Position of each point in this order.
    """

    expansions: Expansions
    near: tuple[bsr_array, ...]
    leaves: Indices
    counts: Indices
    offsets: AnyComplexes
    places: Indices

    @classmethod
    def of(cls, panels: Panels, points: Complexes, *, single: bool = False) -> Self:
        """Prepare the integrals at points (t,).

        They lie strictly inside the outline, by at least some 1e-14 of its size. Single precision
        needs half the memory; its error away from a point is 2e-7 of the largest density.
        """
        acting = find_interactions(panels, points)
        squares, near = acting.squares, acting.near
        counts = squares.ends[squares.leaves] - squares.starts[squares.leaves]
        ascending = np.argsort(counts, kind="stable")
        leaves, counts = squares.leaves[ascending], counts[ascending]
        number, place = ragged_indices(counts)
        leaf = leaves[number]
        order = squares.order[squares.starts[leaf] + place]
        z = points[order]
        places = np.empty_like(order)
        places[order] = np.arange(len(order))
        count = len(panels)
        keys = near.squares * count + near.clusters
        alone = np.array(
            [
                ~np.isin(near.squares * count + beside[near.clusters], keys)
                for beside in (panels.previous_panels, panels.next_panels)
            ]
        )
        # The near pairs of a leaf hold for each of its points.
        first = np.searchsorted(near.squares, leaf)
        rows, place = ragged_indices(np.searchsorted(near.squares, leaf, side="right") - first)
        own = first[rows] + place
        pairs = panels, z, rows, near.clusters[own], alone[:, own]
        offsets = (z - squares.centre[leaf]) / squares.radius[leaf]
        return cls(
            expansions=Expansions.of(panels, acting, single=single),
            near=near_matrices(*pairs) if single else (near_matrix(*pairs),),
            leaves=freeze(leaves),
            counts=freeze(counts),
            offsets=freeze(offsets.astype(np.complex64 if single else np.complex128)),
            places=freeze(places),
        )

    def __call__(self, densities: Floats) -> tuple[Complexes, Complexes]:
        """Return g and g', complex128 (t, j), of densities (N, j) at the nodes of the panels."""
        columns, count = densities.shape[1], len(self.offsets)
        first, *others = self.near
        near = first @ densities
        for other in others:
            near += other @ densities.astype(other.dtype)
        parts = near.reshape(count, 2, 2, columns)
        far = self._far(densities)
        results = np.empty((2, columns, count), dtype=np.complex128)
        for start in range(0, count, BLOCK):
            rows = self.places[start : start + BLOCK]
            block = results[:, :, start : start + BLOCK]
            block[:] = far[rows].transpose(1, 2, 0)
            exact = parts[rows]
            block.real += exact[:, :, 0].transpose(1, 2, 0)
            block.imag += exact[:, :, 1].transpose(1, 2, 0)
        return results[0].T, results[1].T

    def _far(self, densities: Floats) -> AnyComplexes:
        """Return the far panels' part of g and g' in the order of the leaves, (t, 2, j)."""
        squares, columns = self.expansions.squares, densities.shape[1]
        polynomials = self.expansions(densities)[self.leaves]
        slopes = np.zeros_like(polynomials)
        slopes[:, :-1] = polynomials[:, 1:]
        slopes *= np.arange(1.0, TERMS + 1)[:, None] / squares.radius[self.leaves, None, None]
        both = np.concatenate([polynomials, slopes], axis=2)
        found = np.empty((len(self.offsets), 2 * columns), dtype=both.dtype)
        for leaves, points, count in self._runs():
            raised = powers(self.offsets[points]).T.reshape(-1, count, TERMS)
            np.matmul(raised, both[leaves], out=found[points].reshape(-1, count, 2 * columns))
        return found.reshape(-1, 2, columns)

    def _runs(self) -> Iterator[tuple[slice, slice, int]]:
        """Yield runs of leaves with equal numbers of points: leaves, their points, the number."""
        changes = np.flatnonzero(np.diff(self.counts)) + 1
        first = 0
        for start, end in pairwise([0, *changes, len(self.counts)]):
            count = int(self.counts[start])
            last = first + count * (end - start)
            yield slice(start, end), slice(first, last), count
            first = last
