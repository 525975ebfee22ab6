"""Keyframes at the sites, and what all variants have in common on the way from one to the next.

In: harmonic maps, sites, a course.
Out: log f_z of in-betweens, and what each keyframe contributes to them.
Imports: `engine.interpolation.time_weights`, `engine.interpolation.series`,
`engine.interpolation.sampled_domain`.
"""

from engine.interpolation.keyframe_blend.derivatives import (
    Derivatives as Derivatives,
    KeyframeBlend as KeyframeBlend,
    weighted_sum as weighted_sum,
)
from engine.interpolation.keyframe_blend.keyframe_samples import (
    KeyframeSamples as KeyframeSamples,
    sample_keyframes as sample_keyframes,
)
from engine.interpolation.keyframe_blend.segment import (
    BoundaryResidual as BoundaryResidual,
    KeyframeSegment as KeyframeSegment,
)
