"""In-betweens at the cost of a linear blend: series in time, built once for a segment.

In: in-betweens of two keyframes; or a whole motion, as points at any time.
Out: `Series`: a few arrays whose weighted sum is a frame; `MorphTargets`: a whole motion within a
tolerance, for other programs.
Imports: `engine.interpolation`.
"""

from engine.interpolation import finish as finish
from engine.streaming.build import build_series as build_series
from engine.streaming.components import (
    Distortions as Distortions,
    MotionComponents as MotionComponents,
    Positions as Positions,
)
from engine.streaming.morph_targets import (
    MorphTargets as MorphTargets,
    build_morph_targets as build_morph_targets,
)
from engine.streaming.series import Series as Series, SeriesPiece as SeriesPiece
from engine.streaming.splitting import MOST_ROWS as MOST_ROWS
