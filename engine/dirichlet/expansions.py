"""The far panels' part of a Cauchy integral: a fast multipole method as small matrix products.

The moments of the densities about the centres of clusters become Taylor polynomials about the
centres of squares. These become the polynomials of the squares' quarters (Greengard and Rokhlin
1987). The matrices of all these translations depend on the panels and the points only. They are
kept, so the translation of densities consists of matrix products only. Most translations are from
moments to polynomials; they share one matrix, with a diagonal on each side.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any, NamedTuple, Self

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array
from scipy.special import comb

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.dirichlet.interactions import Clusters, Interactions
from engine.dirichlet.panels import NODES, Panels
from engine.dirichlet.quadtree import Squares

AnyComplexes = npt.NDArray[np.complexfloating[Any, Any]]

# Of expansions; their error is at most FAR^-TERMS = 7e-8 of the largest density.
TERMS = 18
NEGLIGIBLE = 1e-20  # of an entry; products of smaller entries would be slow
BLOCK = 512  # pairs of sources and targets that are computed at a time


class Translation(NamedTuple):
    """Matrices to some targets, each from the same number of sources.

    `targets` are intp (n,), `sources` intp (n, m). `matrices` (n, TERMS, m · length) act on
    `length` numbers of each source.
    """

    targets: Indices
    sources: Indices
    matrices: AnyComplexes

    def add(self, given: npt.NDArray[np.inexact], into: AnyComplexes) -> None:
        """Add the image of values (c, length, j) of the sources to the targets' (q, TERMS, j)."""
        count, _, length = self.matrices.shape
        sources = given[self.sources].reshape(count, length, -1)
        into[self.targets] += self.matrices @ sources


class MomentToLocal(NamedTuple):
    """From the moments of clusters to the polynomials of squares far from them.

    1 / (ζ − z) = Σ binom(i + k, k) (z − c_T)^i (c_S − ζ)^k / (c_S − c_T)^(i + k + 1), so the
    matrices differ only by factors of their rows and columns.

    Attributes
    ----------
    targets : intp, shape (n,)
    sources : intp, shape (p,)
        Sources of the pairs, in the order of the targets.
    columns, rows : complex, shape (p, TERMS)
        (r_S / (c_S − c_T))^(k + 1) and (r_T / (c_S − c_T))^i.
    sums : csr_array, shape (n, p)
        Adds up the pairs of each target.
    """

    targets: Indices
    sources: Indices
    columns: AnyComplexes
    rows: AnyComplexes
    sums: csr_array

    def add(self, moments: AnyComplexes, into: AnyComplexes) -> None:
        """Add the image of moments (c, TERMS, j) to the targets' polynomials (q, TERMS, j)."""
        given = moments[self.sources]
        given *= self.columns[:, :, None]
        # As real numbers, since the binomials are real.
        reals = given.view(given.real.dtype)
        added = (_binomials().astype(reals.dtype) @ reals).view(given.dtype)
        added *= self.rows[:, :, None]
        # Several times as fast as `np.add.reduceat`.
        found = self.sums @ added.view(reals.dtype).reshape(len(added), -1)
        into[self.targets] += found.view(given.dtype).reshape(len(found), TERMS, -1)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Expansions:
    """From densities to Taylor polynomials of squares; build it with `Expansions.of`.

    All arrays are complex128, or all are complex64.

    Attributes
    ----------
    panels : complex, shape (p, TERMS, NODES)
        From the densities on panels to their moments Σ m ((c − ζ) / r)^k / r.
    m2m : tuple of Translation
        From the moments of clusters to those of the next level, level by level.
    m2l : tuple of MomentToLocal
        From moments to polynomials.
    p2l : tuple of Translation
        From densities on panels to polynomials.
    """

    squares: Squares
    panels: AnyComplexes
    m2m: tuple[Translation, ...]
    m2l: tuple[MomentToLocal, ...]
    p2l: tuple[Translation, ...]

    @classmethod
    def of(cls, panels: Panels, acting: Interactions, *, single: bool) -> Self:
        clusters, count = acting.clusters, len(panels)
        centre, radius = clusters.centre[:count, None], clusters.radius[:count, None]
        differentials = panels.differentials() / (2j * np.pi)
        to_moments = powers((centre - panels.nodes) / radius) * (differentials / radius)
        return cls(
            squares=acting.squares,
            panels=_kept(to_moments.transpose(1, 0, 2), single=single),
            m2m=tuple(_m2m(clusters, single=single)),
            m2l=tuple(_m2l(acting, single=single)),
            p2l=tuple(_p2l(panels, acting, single=single)),
        )

    def __call__(self, densities: Floats) -> AnyComplexes:
        """Return the polynomials (q, TERMS, j) of the squares, of densities (N, j)."""
        squares, columns = self.squares, densities.shape[1]
        precision = self.panels.dtype
        given = densities.reshape(-1, NODES, columns).astype(self.panels.real.dtype, copy=False)
        count = len(given) + sum(len(each.targets) for each in self.m2m)
        moments = np.zeros((count, TERMS, columns), dtype=precision)
        moments[: len(given)] = self.panels @ given
        for level in self.m2m:
            level.add(moments, moments)
        taylor = np.zeros((len(squares.centre), TERMS, columns), dtype=precision)
        for conversion in self.m2l:
            conversion.add(moments, taylor)
        for translation in self.p2l:
            translation.add(given, taylor)
        for below in squares.levels[1:]:
            to_quarters = _l2l().astype(precision)[squares.quadrant[below]]
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
    """Return matrices in the requested precision, without negligible entries."""
    kept: AnyComplexes = matrices.astype(np.complex64 if single else np.complex128, order="C")
    for part in (kept.real, kept.imag):
        part[np.abs(part) < NEGLIGIBLE] = 0.0
    return freeze(kept)


def _m2m(clusters: Clusters, *, single: bool) -> Iterator[Translation]:
    """Yield the translations from each level of clusters to the next."""
    ranks = np.arange(TERMS)
    raised = np.maximum(ranks[:, None] - ranks, 0)
    for (below, first), (_, end) in pairwise(pairwise(clusters.firsts)):
        parents = np.arange(first, end)
        children = below + 2 * (parents - first)[:, None] + np.arange(2)
        # The last cluster may have one child.
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


def _m2l(acting: Interactions, *, single: bool) -> Iterator[MomentToLocal]:
    """Yield the conversions of far pairs, in blocks."""
    squares, clusters = acting.squares, acting.clusters
    targets, starts = np.unique(acting.far.squares, return_index=True)
    # Blocks hold slightly more pairs than BLOCK: all pairs of a target are in one block.
    heads = np.flatnonzero(np.diff(starts // BLOCK, prepend=-1))
    ends = np.append(starts, len(acting.far.squares))
    for head, tail in pairwise([*heads, len(targets)]):
        target, source = acting.far.of(slice(ends[head], ends[tail]))
        inverse = 1.0 / (clusters.centre[source] - squares.centre[target])
        given = clusters.radius[source] * inverse
        ones = np.ones(len(source), dtype=np.float32 if single else np.float64)
        own = ends[head : tail + 1] - ends[head]
        yield MomentToLocal(
            targets=freeze(targets[head:tail]),
            sources=freeze(source),
            columns=_kept((powers(given) * given).T, single=single),
            rows=_kept(powers(squares.radius[target] * inverse).T, single=single),
            sums=csr_array((ones, np.arange(len(source)), own), (tail - head, len(source))),
        )


def _p2l(panels: Panels, acting: Interactions, *, single: bool) -> Iterator[Translation]:
    """Yield the translations of panels; squares with equal numbers of panels come together."""
    squares, pairs = acting.squares, acting.direct
    nodes, differentials = panels.nodes, panels.differentials() / (2j * np.pi)
    targets, starts, counts = np.unique(pairs.squares, return_index=True, return_counts=True)
    for count in np.unique(counts):
        own = np.flatnonzero(counts == count)
        size = max(1, BLOCK // count)
        for part in np.split(own, range(size, len(own), size)):
            sources = pairs.clusters[starts[part, None] + np.arange(count)]
            square = targets[part, None, None]
            inverse = 1.0 / (nodes[sources] - squares.centre[square])
            matrices = powers(squares.radius[square] * inverse) * (inverse * differentials[sources])
            joined = matrices.transpose(1, 0, 2, 3).reshape(len(part), TERMS, count * NODES)
            yield Translation(targets[part], sources, _kept(joined, single=single))


@cache
def _binomials() -> Floats:
    """Return binom(i + k, k), the part of moment k in the power i."""
    ranks = np.arange(TERMS)
    return freeze(comb(ranks[:, None] + ranks, ranks).astype(np.float64))


@cache
def _l2l() -> Complexes:
    """Return the matrices (4, TERMS, TERMS) from a square's polynomial to its quarters'."""
    ranks = np.arange(TERMS)
    raised = np.maximum(ranks - ranks[:, None], 0)
    # For Σ c_k ((z − c) / r)^k, half the radius, and a centre moved by half a side.
    shifts = np.array([-1 - 1j, 1 - 1j, -1 + 1j, 1 + 1j]) / np.sqrt(8)
    binomials = comb(ranks, ranks[:, None])
    matrices = binomials * shifts[:, None, None] ** raised * 0.5 ** ranks[:, None]
    return freeze(np.asarray(matrices, dtype=np.complex128))
