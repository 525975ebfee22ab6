"""In-betweens at the cost of a linear blend: series in time, built once for an interval.

In: in-betweens of two keyframes; or a whole motion, as points at any time.
Out: `Series`: a few arrays whose weighted sum is a frame; `ShapeTargets`: the same for other
programs, of a whole motion within a tolerance.
Imports: `engine.interpolation`.
"""

from engine.streaming.build import build_series, finish
from engine.streaming.channels import Channels, Distortions, Positions
from engine.streaming.cutting import MOST_ROWS
from engine.streaming.series import Series, SeriesPiece
from engine.streaming.targets import ShapeTargets, build_targets

__all__ = [
    "MOST_ROWS",
    "Channels",
    "Distortions",
    "Positions",
    "Series",
    "SeriesPiece",
    "ShapeTargets",
    "build_series",
    "build_targets",
    "finish",
]
