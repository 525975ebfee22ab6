"""Single places that move, whatever they are places of.

In: where a place is at frames, or was recorded at any times.
Out: how a spring swings about it, at any time; few keys for what was recorded.
Imports: `engine.arrays`, `engine.errors`.
"""

from engine.geometry.kinematics.recordings import FittedKeys as FittedKeys, fit_keys as fit_keys
from engine.geometry.kinematics.springs import (
    FADE_FRAMES as FADE_FRAMES,
    SpringResponse as SpringResponse,
    frames_to_settle as frames_to_settle,
    simulate_spring as simulate_spring,
    turn_arm as turn_arm,
)
