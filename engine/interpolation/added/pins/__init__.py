"""Handles that stay where they are between two keyframes: corrections as series in time.

In: in-betweens, and where handles are wanted during a segment.
Out: h and q (`engine.deform.relative.correction`) as few functions times series in time, folded
into in-betweens.
Imports: `engine.deform.relative.correction`, `engine.interpolation.passage` and its series.
"""

from engine.interpolation.added.pins.folded import FoldedPins as FoldedPins
from engine.interpolation.added.pins.pinning import (
    BaseAt as BaseAt,
    PinSeries as PinSeries,
    pin as pin,
)
from engine.interpolation.added.pins.targets import SegmentPins as SegmentPins
