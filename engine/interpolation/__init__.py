"""Interpolation of harmonic keyframes: every variant of the paper, by `prepare`.

In: harmonic maps of one domain, points, a variant, times.
Out: positions, f_z and f_z̄ of the points at any time; series in time;
proof that the in-betweens keep their bounds.
Imports: `engine.paths`, `engine.dirichlet`, `engine.maps`.
"""

from engine.interpolation.added.pins import (
    CorrectionBase as CorrectionBase,
    CorrectionSeries as CorrectionSeries,
    SegmentPins as SegmentPins,
    SpanBasis as SpanBasis,
)
from engine.interpolation.blends import BLENDS as BLENDS
from engine.interpolation.inbetweens import Frame as Frame, Inbetweens as Inbetweens
from engine.interpolation.keyframe_blend import (
    KeyframeBlend as KeyframeBlend,
    KeyframeSamples as KeyframeSamples,
    KeyframeSegment as KeyframeSegment,
    sample_keyframes as sample_keyframes,
)
from engine.interpolation.one_segment import (
    evaluate_base as evaluate_base,
    frame_at as frame_at,
    prepare_inbetweens as prepare_inbetweens,
    solve_pins as solve_pins,
    value_points_for_corrections as value_points_for_corrections,
)
from engine.interpolation.preparation import (
    TWO_KEYFRAMES as TWO_KEYFRAMES,
    Prepared as Prepared,
    prepare as prepare,
    require_keyframes as require_keyframes,
    segment_at as segment_at,
)
from engine.interpolation.proof import (
    FrameCorrection as FrameCorrection,
    Proof as Proof,
    correct_frame as correct_frame,
    prove as prove,
)
from engine.interpolation.sampled_domain import (
    SampledDomain as SampledDomain,
    sample_domain as sample_domain,
)
from engine.interpolation.scaling import (
    KeyframeExtremes as KeyframeExtremes,
    PointSamples as PointSamples,
    SmoothedRho as SmoothedRho,
    blend_in_outline_bounds as blend_in_outline_bounds,
)
from engine.interpolation.series import chebyshev as chebyshev, finish as finish
from engine.interpolation.time_weights import (
    EndCondition as EndCondition,
    InteriorKnot as InteriorKnot,
    Tangent as Tangent,
    TimeWeights as TimeWeights,
    support_of as support_of,
)
from engine.variant import Variant as Variant
