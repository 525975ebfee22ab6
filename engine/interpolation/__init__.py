"""Interpolation of harmonic keyframes: every variant of the paper behind `prepare`.

In: harmonic maps of one domain, points, a variant, times.
Out: positions, f_z and f_z̄ of the points at any time; series in time;
proof that they keep their bounds.
Imports: `engine.paths`, `engine.dirichlet`, `engine.maps`.
"""

from engine.interpolation.added.pins import (
    BaseAt as BaseAt,
    CorrectionSeries as CorrectionSeries,
    SegmentPins as SegmentPins,
    SpanBasis as SpanBasis,
)
from engine.interpolation.blends import BLENDS as BLENDS
from engine.interpolation.courses import (
    Course as Course,
    End as End,
    Joint as Joint,
    Tangent as Tangent,
    windows_of as windows_of,
)
from engine.interpolation.inbetweens import Frame as Frame, Inbetweens as Inbetweens
from engine.interpolation.one_interval import (
    base_at as base_at,
    frame_at as frame_at,
    prepare_inbetweens as prepare_inbetweens,
    solve_pins as solve_pins,
    value_points_for_corrections as value_points_for_corrections,
)
from engine.interpolation.passage import (
    Interval as Interval,
    KeyframeSamples as KeyframeSamples,
    Passage as Passage,
    sample_keyframes as sample_keyframes,
)
from engine.interpolation.preparation import (
    TWO_KEYFRAMES as TWO_KEYFRAMES,
    Prepared as Prepared,
    interval_at as interval_at,
    prepare as prepare,
    require_keyframes as require_keyframes,
)
from engine.interpolation.proof import (
    FrameCorrection as FrameCorrection,
    Proof as Proof,
    correct_frame as correct_frame,
    prove as prove,
)
from engine.interpolation.scaling import (
    PointSamples as PointSamples,
    Scaling as Scaling,
    Worst as Worst,
    looseness as looseness,
)
from engine.interpolation.series import chebyshev as chebyshev, finish as finish
from engine.interpolation.sites import Sites as Sites, prepare_sites as prepare_sites
from engine.variant import Variant as Variant
