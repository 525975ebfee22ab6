"""Single places that move, whatever they are places of.

In: where a place is at frames.
Out: how a spring swings about it, at any time.
Imports: `engine.arrays`, `engine.errors`.
"""

from engine.geometry.kinematics.springs import Swing as Swing, swing as swing
