"""Interpolation of harmonic keyframes: every variant of the paper behind `prepare`.

In: harmonic maps of one domain, points, a variant, times.
Out: positions, f_z and f_z̄ of the points at any time; series in time;
proof that they keep their bounds.
Imports: `engine.paths`, `engine.dirichlet`, `engine.maps`.
"""

from engine.interpolation import chebyshev
from engine.interpolation.inbetweens import Frame, Inbetweens, IntegratedInbetweens
from engine.interpolation.keyframe_samples import KeyframeSamples, sample_keyframes
from engine.interpolation.passing import Course, End, Joint, Tangent, shortened
from engine.interpolation.preparation import (
    Prepared,
    frame_at,
    interval_at,
    prepare,
    prepare_inbetweens,
    require_keyframes,
)
from engine.interpolation.proof import Proof, prove
from engine.interpolation.scaling import PointSamples, Scaling, Worst, looseness
from engine.interpolation.sites import Sites, prepare_sites
from engine.variant import Variant

__all__ = [
    "Course",
    "End",
    "Frame",
    "Inbetweens",
    "IntegratedInbetweens",
    "Joint",
    "KeyframeSamples",
    "PointSamples",
    "Prepared",
    "Proof",
    "Scaling",
    "Sites",
    "Tangent",
    "Variant",
    "Worst",
    "chebyshev",
    "frame_at",
    "interval_at",
    "looseness",
    "prepare",
    "prepare_inbetweens",
    "prepare_sites",
    "prove",
    "require_keyframes",
    "sample_keyframes",
    "shortened",
]
