"""Samples of the outline on which a map over the cage is measured and bounded."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, as_points, readonly
from engine.geometry import (
    box_diagonal,
    distance_to_segments,
    require_around,
    require_simple,
    sample_graded,
)
from engine.maps.cauchy import cauchy_coordinates, cauchy_derivatives

# Longest segments of the outline, over their distance to the nearest cage vertex, and over the
# diagonal of the outline. Measured: the extremes on the samples are then within a few thousandths
# of those on the whole outline.
SEGMENT_PER_DISTANCE = 0.5
SEGMENT_PER_SIZE = 1 / 200


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Boundary:
    """An outline inside a cage, sampled as densely as the derivatives of maps ask for.

    Build it with `Boundary.sample`; it depends on the shape only and serves all maps over the cage.

    Parameters
    ----------
    outline, cage : complex128, shapes (p,) and (n,)
    size : float
        L, the diagonal of the outline's bounding box.
    points : complex128, shape (m,)
        Samples in order along the outline; segment i leads from sample i to sample i + 1.
    weights : float64, shape (m,)
        Of the samples in means over the outline, with sum 1: the arc length that belongs to each,
        and 0 for those that were added. Sums do not change by refinement.
    spacing : float64, shape (m,)
        The arc length that belongs to each sample, added or not, with sum 1.
    half_lengths : float64, shape (m,)
        Of the segments.
    derivatives : complex128, shape (m, n)
        C_j' at the samples.
    curvature_kernel : float64, shape (m, n)
        1 / (2π d_j²) with d_j the distance of cage vertex j from the segment: times the jumps of
        Δφ/Δz it bounds |Φ'''| on the segment.
    vertex_coordinates : complex128, shape (p, n)
        C_j at the outline's vertices.
    """

    outline: Complexes
    cage: Complexes
    size: float
    points: Complexes
    weights: Floats
    spacing: Floats
    half_lengths: Floats
    derivatives: Complexes
    curvature_kernel: Floats
    vertex_coordinates: Complexes

    @classmethod
    def sample(cls, outline: Complexes, cage: Complexes) -> Self:
        """Sample an outline.

        Parameters
        ----------
        outline, cage : complex128, shapes (p,) and (n,)
            Counter-clockwise polygons. The outline is simple and lies strictly inside the cage. The
            cage may cross itself away from the outline, as some published ones do.

        Raises
        ------
        EngineError
            If the outline is not simple, or not strictly inside the cage.
        """
        outline, cage = (
            as_points(outline, "outline", at_least=3),
            as_points(cage, "cage", at_least=3),
        )
        require_simple(outline, "outline")
        require_around(cage, outline)
        size = box_diagonal(outline)
        points = sample_graded(
            outline, cage, ratio=SEGMENT_PER_DISTANCE, longest=SEGMENT_PER_SIZE * size
        )
        ends = np.roll(points, -1)
        half = np.abs(ends - points) / 2
        lengths = readonly(_arc_lengths(half))
        return cls(
            outline=outline,
            cage=cage,
            size=size,
            points=readonly(points),
            weights=lengths,
            spacing=lengths,
            half_lengths=readonly(half),
            derivatives=readonly(cauchy_derivatives(cage, points)),
            curvature_kernel=readonly(_curvature_kernel(cage, points, ends)),
            vertex_coordinates=readonly(cauchy_coordinates(cage, outline)),
        )

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        arrays = (self.points, self.derivatives, self.curvature_kernel, self.vertex_coordinates)
        return sum(array.nbytes for array in arrays)

    def refined(self, segments: Indices) -> Self:
        """Return the same outline with one more sample in the middle of each given segment.

        Parameters
        ----------
        segments : int, shape (s,)
            In any order.
        """
        segments = np.unique(segments)
        starts = self.points[segments]
        ends = self.points[(segments + 1) % len(self.points)]
        middles = (starts + ends) / 2
        points = np.insert(self.points, segments + 1, middles)
        half = np.insert(self.half_lengths, segments + 1, 0.0)
        kernel = np.insert(self.curvature_kernel, segments + 1, 0.0, axis=0)
        first = segments + np.arange(len(segments))
        half[first] = half[first + 1] = self.half_lengths[segments] / 2
        kernel[first] = _curvature_kernel(self.cage, starts, middles)
        kernel[first + 1] = _curvature_kernel(self.cage, middles, ends)
        rows = cauchy_derivatives(self.cage, middles)
        return replace(
            self,
            points=readonly(points),
            weights=readonly(np.insert(self.weights, segments + 1, 0.0)),
            spacing=readonly(_arc_lengths(half)),
            half_lengths=readonly(half),
            derivatives=readonly(np.insert(self.derivatives, segments + 1, rows, axis=0)),
            curvature_kernel=readonly(kernel),
        )


def _arc_lengths(half_lengths: Floats) -> Floats:
    """Return the arc length from the middle of the segment before each sample to that after it."""
    lengths: Floats = half_lengths + np.roll(half_lengths, 1)
    lengths /= lengths.sum()
    return lengths


def _curvature_kernel(cage: Complexes, starts: Complexes, ends: Complexes) -> Floats:
    kernel: Floats = 1.0 / (2 * np.pi * distance_to_segments(cage, starts, ends).T ** 2)
    return kernel
