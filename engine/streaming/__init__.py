"""In-betweens at the cost of a linear blend: series in time, built once for an interval.

In: in-betweens of two keyframes; or a whole motion, as points at any time.
Out: `Series`: a few arrays whose weighted sum is a frame; `ShapeTargets`: the same for other
programs, of a whole motion within a tolerance.
Imports: `engine.interpolation`.
"""

from engine.interpolation import finish as finish
from engine.streaming.build import build_series as build_series
from engine.streaming.channels import (
    Channels as Channels,
    Distortions as Distortions,
    Positions as Positions,
)
from engine.streaming.cutting import MOST_ROWS as MOST_ROWS
from engine.streaming.series import Series as Series, SeriesPiece as SeriesPiece
from engine.streaming.targets import ShapeTargets as ShapeTargets, build_targets as build_targets
