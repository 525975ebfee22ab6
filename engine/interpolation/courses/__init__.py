"""The way from one keyframe to the next in time, and through keyframes at one velocity.

In: how the motion passes keyframes; bounds.
Out: weights of the keyframes at any time; tangents that are short enough.
Imports: `engine.maps`.
"""

from engine.interpolation.courses.course import (
    Course as Course,
    End as End,
    Joint as Joint,
    Tangent as Tangent,
    windows_of as windows_of,
)
from engine.interpolation.courses.tangents import (
    Range as Range,
    allowed_velocities as allowed_velocities,
    are_same as are_same,
    curb as curb,
    curbed as curbed,
    derivatives_along as derivatives_along,
    shortened as shortened,
    shortened_metric as shortened_metric,
)
