"""All that the in-betweens of two neighbouring keyframes are made of, but for their variant."""

from typing import NamedTuple

from engine.arrays import nbytes_of
from engine.dirichlet import Densities, Extension
from engine.interpolation.keyframe_blend.derivatives import KeyframeBlend
from engine.interpolation.sampled_domain import SampledDomain
from engine.interpolation.series import PiecewiseSeries
from engine.maps import Bounds


class BoundaryResidual(NamedTuple):
    """What the metric variant adds to log f_z, known on the boundary: it serves any points.

    Parameters
    ----------
    densities : Densities
        Of few holomorphic functions (j,).
    series : PiecewiseSeries
        What they are multiplied by.
    """

    densities: Densities
    series: PiecewiseSeries

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return nbytes_of(self)


class KeyframeSegment(NamedTuple):
    """Two keyframes at the sites, and how the motion leads from one to the other.

    What it has is shared, not copied: sites by all keyframes, keyframes by the intervals on both
    sides.

    Parameters
    ----------
    sites : SampledDomain
    passage : KeyframeBlend
        The keyframes, with those around them that the course weighs.
    bounds : Bounds
        That metric and a scaled variant obey along courses that are not straight; else they obey
        their keyframes' own.
    transform : Extension or None
        Of the sites' outline, at the nodes of their paths; variants that `needs_transform` says so
        of need it.
    residual : BoundaryResidual or None
        What `Blend.on_boundary` returned for these keyframes at any sites of the domain.
    """

    sampled_domain: SampledDomain
    keyframe_blend: KeyframeBlend
    bounds: Bounds
    transform: Extension | None = None
    residual: BoundaryResidual | None = None
