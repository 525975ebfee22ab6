"""Corrections of in-betweens as series in time; those of handles that stay in a segment.

In: in-betweens, and targets for handles during a segment.
Out: h and q (`engine.deform.correction`) as few functions times series in time, folded into
in-betweens.
Imports: `engine.deform.correction`, `engine.interpolation.passage` and its series.
"""

from engine.interpolation.added.pins.folded import (
    FoldedCorrection as FoldedCorrection,
    Mixing as Mixing,
    SpanBasis as SpanBasis,
)
from engine.interpolation.added.pins.pinning import (
    BaseAt as BaseAt,
    CorrectionSeries as CorrectionSeries,
    pin as pin,
)
from engine.interpolation.added.pins.targets import SegmentPins as SegmentPins
