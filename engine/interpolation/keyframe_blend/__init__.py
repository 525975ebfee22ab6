"""Keyframes at a sampled domain, and the part of the blend that all variants share.

In: harmonic maps, a sampled domain, time weights.
Out: log f_z of in-betweens, and the samples and weight of each keyframe.
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
