"""In-betweens at the cost of a linear blend: series in time, built once for an interval.

In: in-betweens of two keyframes.
Out: `Series`: a few arrays whose weighted sum is a frame.
Imports: `engine.interpolation`, `engine.chebyshev`.
"""

from engine.streaming.build import MOST_ROWS, build_series, finish
from engine.streaming.channels import Channels, Distortions, Positions
from engine.streaming.series import Series, SeriesPiece

__all__ = [
    "MOST_ROWS",
    "Channels",
    "Distortions",
    "Positions",
    "Series",
    "SeriesPiece",
    "build_series",
    "finish",
]
