"""Samples of the outline at which a map over the cage is measured and bounded."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Indices, freeze, readonly, require_kind
from engine.geometry import (
    Domain,
    Hole,
    diameter,
    next_on_loop,
    require_around,
    require_cages_in_holes,
    require_simple,
    sample_graded,
)
from engine.maps.span import Span
from engine.maps.stiffness import require_stiffness, stiffness_along_loops

# Longest segments of the outline, over their distance to the nearest cage vertex, and over the
# diameter of the outline. Measured: the extremes on the samples are then within a few thousandths
# of those on the whole outline.
SEGMENT_PER_DISTANCE = 0.5
SEGMENT_PER_SIZE = 1 / 200


@dataclass(frozen=True, kw_only=True, eq=False)
class Boundary:
    """The boundary of a domain, sampled as densely as the derivatives of maps need.

    Build it with `Boundary.sample`; it depends on the shape only and serves all maps on it.

    Parameters
    ----------
    span : Span
        The functions of maps: cage and holes.
    size : float
        L, the diameter of the outline.
    points : complex128, shape (m,)
        Samples in order along the outline, then along the loop of each hole, the domain on the
        left; segment i leads from sample i to the next one on its loop.
    starts : intp, shape (1 + holes,)
        The first sample of each loop.
    weights : float64, shape (m,)
        Weights in the energy: the arc length of each sample, with sum 1, times the stiffness there,
        and 0 for added samples. Refinement does not change sums.
    barrier_weights : float64, shape (m,)
        Weights in sums of barriers: `weights`, and for added samples the mean weight. A bound that
        presses at one of these few points then keeps as much slack as others.
    stiffness : float64, shape (m,)
        At the samples, 1 unless the boundary is `stiffened`.
    half_lengths : float64, shape (m,)
        Of the segments.
    derivatives : complex128, shape (m, n)
        C_j' and 1 / (z − c_j) of the n functions of the span, at the samples.
    third_derivative_kernel : float64, shape (m, n)
        Times `Span.singularity_strengths` it bounds |Φ'''| on the segment.
    vertex_coordinates : complex128, shape (p, n)
        The functions' values at the vertices of all loops.
    basis : complex128, shape (n, r)
        The coefficients, one function a column, of `Span.orthonormal_basis` on the own samples; all
        but the constants have the mean 0 at the vertices.
    basis_derivatives : complex128, shape (m, r)
        Of the functions of the basis.
    """

    domain: Domain
    span: Span
    size: float
    points: Complexes
    starts: Indices
    weights: Floats
    barrier_weights: Floats
    stiffness: Floats
    half_lengths: Floats
    derivatives: Complexes
    third_derivative_kernel: Floats
    vertex_coordinates: Complexes
    basis: Complexes
    basis_derivatives: Complexes

    @classmethod
    def sample(cls, domain: Domain) -> Self:
        """Sample the boundary of a domain.

        Raises
        ------
        EngineError
            If the outline is not simple, or not strictly inside the cage, or a hole is not inside
            the outline, or its cage not in the hole.
        """
        require_kind(domain, Domain, "domain")
        outline, cage, holes, loops = domain.outline, domain.cage, domain.holes, domain.loops
        require_simple(outline, "outline")
        require_around(cage, outline)
        require_cages_in_holes(holes, outline)
        span = Span(cage=cage, holes=holes)
        size = diameter(outline)
        singular, longest = np.concatenate([span.vertices, span.centres]), SEGMENT_PER_SIZE * size
        samples = [
            sample_graded(loop, singular, ratio=SEGMENT_PER_DISTANCE, longest=longest)
            for loop in loops
        ]
        points = np.concatenate(samples)
        starts = np.cumsum([0, *map(len, samples[:-1])])
        ends = points[next_on_loop(starts, len(points))]
        half = np.abs(ends - points) / 2
        lengths = readonly(_arc_lengths(half, starts))
        derivatives = readonly(span.derivatives(points))
        vertex_coordinates = readonly(span.coordinates(np.concatenate(loops)))
        basis = span.orthonormal_basis(derivatives, lengths, size)
        # With the mean 0 a handle is about equally stiff against all functions.
        others = basis[:, len(span.cages) :]
        others[: len(cage)] -= vertex_coordinates.mean(axis=0) @ others
        return cls(
            domain=Domain(outline, cage, holes),  # without the caller's mesh
            span=span,
            size=size,
            points=readonly(points),
            starts=readonly(starts),
            weights=lengths,
            barrier_weights=lengths,
            stiffness=freeze(np.ones(len(points))),
            half_lengths=readonly(half),
            derivatives=derivatives,
            third_derivative_kernel=readonly(span.third_derivative_kernel(points, ends)),
            vertex_coordinates=vertex_coordinates,
            basis=readonly(basis),
            basis_derivatives=readonly(derivatives @ basis),
        )

    @property
    def outline(self) -> Complexes:
        """The outer polygon of the boundary."""
        return self.domain.outline

    @property
    def cage(self) -> Complexes:
        """The polygon of the Cauchy coordinates around the outline."""
        return self.domain.cage

    @property
    def holes(self) -> tuple[Hole, ...]:
        return self.domain.holes

    @property
    def loops(self) -> tuple[Complexes, ...]:
        """The polygons of the boundary: the outline, then those of the holes."""
        return self.domain.loops

    @cached_property
    def next_samples(self) -> Indices:
        """The sample at which each segment ends, intp (m,)."""
        return readonly(next_on_loop(self.starts, len(self.points)))

    @cached_property
    def original_samples(self) -> tuple[Indices, list[int]]:
        """The samples that were not added, and the begin and end of each loop among them."""
        own = np.flatnonzero(self.weights)
        return own, np.searchsorted(own, [*self.starts, len(self.points)]).tolist()

    @cached_property
    def has_added_samples(self) -> bool:
        """Whether it was refined."""
        return len(self.original_samples[0]) < len(self.points)

    @cached_property
    def original_neighbours(self) -> tuple[Indices, Indices]:
        """The original samples before and after each sample, counted among the original ones.

        (m,) each. Both are the sample itself where it is original.
        """
        own, ends = self.original_samples
        first = np.searchsorted(own, np.arange(len(self.points)), side="right") - 1
        following = next_on_loop(np.array(ends[:-1]), len(own))[first]
        return readonly(first), readonly(np.where(self.weights > 0, first, following))

    @property
    def lengths(self) -> Floats:
        """The weights of the samples (m,) in means over the boundary, with sum 1."""
        lengths: Floats = self.weights / self.stiffness
        return lengths

    @property
    def mean_stiffness(self) -> float:
        """Mean of the stiffness over the boundary's length."""
        return float(self.weights.sum() / self.lengths.sum())

    def stiffened(self, stiffness: npt.ArrayLike) -> Self:
        """Return the boundary with the same samples and its energy's weights times a stiffness.

        Parameters
        ----------
        stiffness : array_like of float, shape (p,)
            At the vertices of `loops`, one loop after the other, from 1/30 to 100; logarithmically
            linear along the edges.

        Raises
        ------
        EngineError
            If the stiffness has another number of values, or values out of range.
        """
        loops = self.loops
        at_vertices = require_stiffness(stiffness, sum(map(len, loops)))
        at_samples = stiffness_along_loops(
            at_vertices, loops, np.split(self.points, self.starts[1:])
        )
        return self.stiffened_at_samples(at_samples)

    def stiffened_at_samples(self, stiffness: Floats) -> Self:
        """Return the boundary with this stiffness at each sample, float64 (m,)."""
        return replace(
            self, weights=freeze(self.barrier_weights * stiffness), stiffness=readonly(stiffness)
        )

    def stiffness_around(self, points: Complexes) -> tuple[Floats, Floats]:
        """Return the mean and the quadratic mean of the stiffness around points, (h,) each.

        A sample counts by its length over the square of its distance. Along a straight side this is
        the harmonic measure, the weight of the harmonic extension of s into the domain.
        """
        if np.all(self.stiffness == 1.0):
            return np.ones(len(points)), np.ones(len(points))
        squares = np.abs(points[:, None] - self.points) ** 2
        kernel = self.barrier_weights / np.maximum(squares, self.half_lengths**2)
        kernel /= kernel.sum(axis=1, keepdims=True)
        return kernel @ self.stiffness, np.sqrt(kernel @ self.stiffness**2)

    def refined(self, segments: Indices) -> Self:
        """Return the boundary with one more sample in the middle of each given segment (s,)."""
        segments = np.unique(segments)
        starts = self.points[segments]
        ends = self.points[self.next_samples[segments]]
        middles = (starts + ends) / 2
        points = np.insert(self.points, segments + 1, middles)
        loops = self.starts + np.searchsorted(segments, self.starts)
        half = np.insert(self.half_lengths, segments + 1, 0.0)
        kernel = np.insert(self.third_derivative_kernel, segments + 1, 0.0, axis=0)
        first = segments + np.arange(len(segments))
        half[first] = half[first + 1] = self.half_lengths[segments] / 2
        kernel[first] = self.span.third_derivative_kernel(starts, middles)
        kernel[first + 1] = self.span.third_derivative_kernel(middles, ends)
        rows = self.span.derivatives(middles)
        of_basis = np.insert(self.basis_derivatives, segments + 1, rows @ self.basis, axis=0)
        share = 1.0 / np.count_nonzero(self.weights)
        between = np.sqrt(self.stiffness[segments] * self.stiffness[self.next_samples[segments]])
        return replace(
            self,
            points=freeze(points),
            starts=freeze(loops),
            weights=freeze(np.insert(self.weights, segments + 1, 0.0)),
            barrier_weights=freeze(np.insert(self.barrier_weights, segments + 1, share)),
            stiffness=freeze(np.insert(self.stiffness, segments + 1, between)),
            half_lengths=freeze(half),
            derivatives=freeze(np.insert(self.derivatives, segments + 1, rows, axis=0)),
            third_derivative_kernel=freeze(kernel),
            basis_derivatives=freeze(of_basis),
        )


def _arc_lengths(half_lengths: Floats, starts: Indices) -> Floats:
    """Return the arc length around each sample, between the middles of its two segments."""
    lengths: Floats = half_lengths.copy()
    lengths[next_on_loop(starts, len(lengths))] += half_lengths
    lengths /= lengths.sum()
    return lengths
