"""Time weights from one keyframe to the next, and through keyframes with continuous velocity.

In: end conditions at keyframes; bounds.
Out: weights of the keyframes at any time; tangents short enough for the bounds.
Imports: `engine.maps`.
"""

from engine.interpolation.time_weights.tangents import (
    ValueRange as ValueRange,
    allowed_velocities as allowed_velocities,
    are_same_maps as are_same_maps,
    clamp_smoothly as clamp_smoothly,
    derivatives_along as derivatives_along,
    limit_velocity as limit_velocity,
    shorten_metric_tangent as shorten_metric_tangent,
    shorten_tangent as shorten_tangent,
)
from engine.interpolation.time_weights.weights import (
    EndCondition as EndCondition,
    InteriorKnot as InteriorKnot,
    Tangent as Tangent,
    TimeWeights as TimeWeights,
    support_of as support_of,
)
