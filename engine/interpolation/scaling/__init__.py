"""The scaling ρ of η: by the pointwise rule of the paper (Section 7.3), and without kinks.

In: keyframes, an outline, the course through the keys, bounds.
Out: the factor ρ at any time.
Imports: `engine.maps`, `engine.interpolation.blends`, `engine.interpolation.passing`,
    `engine.interpolation.periods`.
"""

from engine.interpolation.scaling.metric import MetricRatios
from engine.interpolation.scaling.sharp import (
    BESIDE_KEY,
    PointSamples,
    SharpScaling,
    Worst,
    looseness,
)
from engine.interpolation.scaling.smooth import Scaling, ScalingEnclosures

__all__ = [
    "BESIDE_KEY",
    "MetricRatios",
    "PointSamples",
    "Scaling",
    "ScalingEnclosures",
    "SharpScaling",
    "Worst",
    "looseness",
]
