"""Interpolation of harmonic keyframes: every variant of the paper, by `prepare`.

In: harmonic maps of one domain, points, a variant, times.
Out: positions, f_z and f_z̄ of the points at any time; series in time;
proof that the in-betweens keep their bounds.
Imports: `engine.paths`, `engine.dirichlet`, `engine.maps`.
"""

from engine.interpolation.added.pins.bones import (
    ChainOfBones as ChainOfBones,
    SegmentBones as SegmentBones,
)
from engine.interpolation.added.pins.evaluated import SpanBasis as SpanBasis
from engine.interpolation.added.pins.pinning import CorrectionSeries as CorrectionSeries
from engine.interpolation.added.pins.segment_solver import CorrectionBase as CorrectionBase
from engine.interpolation.added.pins.targets import SegmentPins as SegmentPins
from engine.interpolation.blends.table import BLENDS as BLENDS
from engine.interpolation.inbetweens import Frame as Frame, Inbetweens as Inbetweens
from engine.interpolation.keyframe_blend.derivatives import KeyframeBlend as KeyframeBlend
from engine.interpolation.keyframe_blend.keyframe_samples import (
    KeyframeSamples as KeyframeSamples,
    sample_keyframes as sample_keyframes,
)
from engine.interpolation.keyframe_blend.segment import KeyframeSegment as KeyframeSegment
from engine.interpolation.one_segment import (
    evaluate_base as evaluate_base,
    frame_at as frame_at,
    prepare_inbetweens as prepare_inbetweens,
    solve_pins as solve_pins,
    solve_pins_at as solve_pins_at,
    value_points_for_corrections as value_points_for_corrections,
)
from engine.interpolation.preparation import (
    TWO_KEYFRAMES as TWO_KEYFRAMES,
    Prepared as Prepared,
    prepare as prepare,
    require_keyframes as require_keyframes,
    segment_at as segment_at,
)
from engine.interpolation.proof.bisection import Proof as Proof, prove as prove
from engine.interpolation.proof.frame_correction import (
    FrameCorrection as FrameCorrection,
    correct_frame as correct_frame,
)
from engine.interpolation.sampled_domain import (
    SampledDomain as SampledDomain,
    sample_domain as sample_domain,
)
from engine.interpolation.scaling.exact_rho import (
    blend_in_outline_bounds as blend_in_outline_bounds,
)
from engine.interpolation.scaling.pointwise import (
    KeyframeExtremes as KeyframeExtremes,
    PointSamples as PointSamples,
)
from engine.interpolation.scaling.smoothed_rho import SmoothedRho as SmoothedRho
from engine.interpolation.series import chebyshev as chebyshev
from engine.interpolation.series.chebyshev import finish as finish
from engine.interpolation.time_weights.weights import (
    EndCondition as EndCondition,
    InteriorKnot as InteriorKnot,
    Tangent as Tangent,
    TimeWeights as TimeWeights,
    support_of as support_of,
)
from engine.variant import Variant as Variant
