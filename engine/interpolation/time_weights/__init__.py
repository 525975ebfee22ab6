"""Time weights from one keyframe to the next, and through keyframes with continuous velocity.

In: end conditions at keyframes; bounds.
Out: weights of the keyframes at any time; tangents short enough for the bounds.
Imports: `engine.maps`.
"""
