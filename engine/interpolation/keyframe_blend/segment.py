"""The input of the in-betweens of two neighbouring keyframes, without the variant."""

from typing import NamedTuple

from engine.arrays import nbytes_of
from engine.dirichlet import Densities, Extension
from engine.interpolation.keyframe_blend.derivatives import KeyframeBlend
from engine.interpolation.sampled_domain import SampledDomain
from engine.interpolation.series.chebyshev import PiecewiseSeries
from engine.maps import Bounds


class BoundaryResidual(NamedTuple):
    """The metric variant's addition to log f_z, given on the boundary and valid for any points.

    `densities` are those of a few holomorphic functions (j,); `series` are their coefficients in
    time.
    """

    densities: Densities
    series: PiecewiseSeries

    @property
    def nbytes(self) -> int:
        return nbytes_of(self)


class KeyframeSegment(NamedTuple):
    """Two keyframes at a sampled domain, and how the motion leads from one to the other.

    The parts are shared, not copied: all keyframes share the sampled domain, and both neighbouring
    segments share a keyframe.

    Attributes
    ----------
    keyframe_blend : KeyframeBlend
        The keyframes, with all neighbours that have a time weight.
    bounds : Bounds
        Bounds for the metric and the scaled variants with curved time weights. Otherwise the bounds
        are those of the keyframes.
    transform : Extension or None
        Transform of the outline at the path nodes; required by variants with `needs_transform`.
    residual : BoundaryResidual or None
        Result of `Blend.on_boundary` for these keyframes and any points of the domain.
    """

    sampled_domain: SampledDomain
    keyframe_blend: KeyframeBlend
    bounds: Bounds
    transform: Extension | None = None
    residual: BoundaryResidual | None = None
