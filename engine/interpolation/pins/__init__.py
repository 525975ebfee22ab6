"""Handles that stay where they are between two keyframes: corrections as series in time.

In: in-betweens, and where handles are wanted during a segment.
Out: h and q (`engine.correction`) as few functions times series in time, folded into in-betweens.
Imports: `engine.correction`, `engine.interpolation.series`, `engine.interpolation.passage`.
"""

from engine.interpolation.pins.folded import FoldedPins as FoldedPins
from engine.interpolation.pins.pinning import (
    BaseAt as BaseAt,
    PinSeries as PinSeries,
    pin as pin,
)
from engine.interpolation.pins.targets import Pins as Pins
