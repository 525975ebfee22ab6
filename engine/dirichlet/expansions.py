"""What far panels contribute to a Cauchy integral: a fast multipole method as small products.

The moments of the densities about the centres of clusters become Taylor polynomials about those of
squares, and these the polynomials of their quarters (Greengard and Rokhlin 1987). The matrices of
all these translations depend on the panels and the points alone. They are kept, so that the
translations of densities are products of matrices and nothing else.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any, NamedTuple, Self

import numpy as np
import numpy.typing as npt
from scipy.special import comb

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.dirichlet.interactions import Clusters, Interactions, Pairs
from engine.dirichlet.panels import NODES, Panels
from engine.dirichlet.quadtree import Squares

AnyComplexes = npt.NDArray[np.complexfloating[Any, Any]]

# Of expansions: they err by FAR^-TERMS = 7e-8 of the largest density at most.
TERMS = 18
NEGLIGIBLE = 1e-20  # of an entry: products of smaller ones would be slow
BLOCK = 1024  # matrices that are worked out at a time


class Translation(NamedTuple):
    """Matrices to some targets, each from as many sources.

    Parameters
    ----------
    targets : intp, shape (n,)
    sources : intp, shape (n, m)
    matrices : complex, shape (n, TERMS, m · length)
        From what is given at the sources, `length` numbers each.
    """

    targets: Indices
    sources: Indices
    matrices: AnyComplexes

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return self.targets.nbytes + self.sources.nbytes + self.matrices.nbytes

    def add(self, given: npt.NDArray[np.inexact], into: AnyComplexes) -> None:
        """Add what is given (c, length, j) at the sources to the targets' (q, TERMS, j)."""
        count, _, length = self.matrices.shape
        sources = given[self.sources].reshape(count, length, -1)
        into[self.targets] += self.matrices @ sources


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Expansions:
    """From densities to Taylor polynomials of squares; build it with `Expansions.of`.

    All of it is complex128, or complex64.

    Parameters
    ----------
    squares : Squares
    panels : complex, shape (p, TERMS, NODES)
        From the densities on panels to their moments Σ m ((c − ζ) / r)^k / r.
    joined : tuple of Translation
        From the moments of clusters to those of the next level's, level by level.
    far : tuple of Translation
        From moments to polynomials.
    direct : tuple of Translation
        From densities on panels to polynomials.
    """

    squares: Squares
    panels: AnyComplexes
    joined: tuple[Translation, ...]
    far: tuple[Translation, ...]
    direct: tuple[Translation, ...]

    @classmethod
    def of(cls, panels: Panels, acting: Interactions, *, single: bool) -> Self:
        """Work out the matrices."""
        squares, clusters = acting.squares, acting.clusters
        nodes, differentials = panels.nodes, panels.differentials() / (2j * np.pi)
        centre, radius = clusters.centre[: len(panels), None], clusters.radius[: len(panels), None]
        to_moments = powers((centre - nodes) / radius) * (differentials / radius)

        def of_moments(pairs: Pairs) -> AnyComplexes:
            # 1 / (ζ − z) = Σ binom(i + k, k) (z − c_T)^i (c_S − ζ)^k / (c_S − c_T)^(i + k + 1).
            source, target = pairs.clusters, pairs.squares
            inverse = 1.0 / (clusters.centre[source] - squares.centre[target])
            given = clusters.radius[source] * inverse
            columns = powers(given).T * given[:, None]
            rows = powers(squares.radius[target] * inverse).T
            matrices: AnyComplexes = rows[:, :, None] * _binomials() * columns[:, None]
            return matrices

        def of_densities(pairs: Pairs) -> AnyComplexes:
            panel, target = pairs.clusters, pairs.squares
            inverse = 1.0 / (nodes[panel] - squares.centre[target, None])
            matrices = powers(squares.radius[target, None] * inverse)
            return (matrices * (inverse * differentials[panel])).transpose(1, 0, 2)

        return cls(
            squares=squares,
            panels=_kept(to_moments.transpose(1, 0, 2), single=single),
            joined=tuple(_joined(clusters, single=single)),
            far=tuple(_grouped(acting.far, of_moments, TERMS, single=single)),
            direct=tuple(_grouped(acting.direct, of_densities, NODES, single=single)),
        )

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        translations = (*self.joined, *self.far, *self.direct)
        own = sum(part.nbytes for part in translations)
        return self.panels.nbytes + self.squares.nbytes + own

    def __call__(self, densities: Floats) -> AnyComplexes:
        """Return the polynomials (q, TERMS, j) of the squares, of densities (N, j)."""
        squares, columns = self.squares, densities.shape[1]
        precision = self.panels.dtype
        given = densities.reshape(-1, NODES, columns).astype(self.panels.real.dtype, copy=False)
        count = len(given) + sum(len(each.targets) for each in self.joined)
        moments = np.zeros((count, TERMS, columns), dtype=precision)
        moments[: len(given)] = self.panels @ given
        for level in self.joined:
            level.add(moments, moments)
        taylor = np.zeros((len(squares.centre), TERMS, columns), dtype=precision)
        for part in self.far:
            part.add(moments, taylor)
        for part in self.direct:
            part.add(given, taylor)
        for below in squares.levels[1:]:
            to_quarters = _to_quarters().astype(precision)[squares.quadrant[below]]
            taylor[below] += to_quarters @ taylor[squares.parent[below]]
        return taylor


def powers(base: AnyComplexes) -> AnyComplexes:
    """Return base^k for k < TERMS, (TERMS, ...)."""
    result = np.empty((TERMS, *base.shape), dtype=base.dtype)
    result[0] = 1.0
    for k in range(1, TERMS):
        np.multiply(result[k - 1], base, out=result[k])
    return result


def _kept(matrices: AnyComplexes, *, single: bool) -> AnyComplexes:
    """Return matrices in the precision that is wanted, without entries that are nothing."""
    kept: AnyComplexes = matrices.astype(np.complex64 if single else np.complex128, order="C")
    for part in (kept.real, kept.imag):
        part[np.abs(part) < NEGLIGIBLE] = 0.0
    return freeze(kept)


def _joined(clusters: Clusters, *, single: bool) -> Iterator[Translation]:
    """Yield the translations from each level of clusters to the next."""
    ranks = np.arange(TERMS)
    raised = np.maximum(ranks[:, None] - ranks, 0)
    for (below, first), (_, end) in pairwise(pairwise(clusters.firsts)):
        parents = np.arange(first, end)
        children = below + 2 * (parents - first)[:, None] + np.arange(2)
        # The last one may have one child.
        alone = children >= first
        children[alone] -= 1
        shrunk = clusters.radius[children] / clusters.radius[parents, None]
        shrunk[alone] = 0.0
        shift = clusters.centre[parents, None] - clusters.centre[children]
        shift /= clusters.radius[parents, None]
        # (c_P − ζ)^k = Σ binom(k, l) (c_P − c_C)^(k − l) (c_C − ζ)^l.
        binomials = comb(ranks[:, None], ranks)[:, None]
        matrices = binomials * powers(shift)[raised].transpose(2, 0, 3, 1)
        matrices *= shrunk[:, None, :, None] ** (1 + ranks)
        joined = matrices.reshape(len(parents), TERMS, 2 * TERMS)
        yield Translation(parents, children, _kept(joined, single=single))


def _grouped(
    pairs: Pairs, matrices_of: Callable[[Pairs], AnyComplexes], length: int, *, single: bool
) -> Iterator[Translation]:
    """Yield the translations of pairs, those to targets of as many sources together."""
    targets, starts, counts = np.unique(pairs.squares, return_index=True, return_counts=True)
    for count in np.unique(counts):
        own = np.flatnonzero(counts == count)
        size = max(1, BLOCK // count)
        for part in np.split(own, range(size, len(own), size)):
            chosen = pairs.of((starts[part, None] + np.arange(count)).ravel())
            matrices = matrices_of(chosen).reshape(len(part), count, TERMS, length)
            joined = matrices.transpose(0, 2, 1, 3).reshape(len(part), TERMS, count * length)
            sources = chosen.clusters.reshape(len(part), count)
            yield Translation(targets[part], sources, _kept(joined, single=single))


@cache
def _binomials() -> Floats:
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
