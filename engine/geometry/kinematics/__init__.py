"""Motions of single places.

In: places at frames, or recorded at any times.
Out: a spring's offsets from a place, at any time; few keys for a recording.
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
