"""Proof of in-betweens: bounds of their distortion, at every time and in the whole domain.

In: the in-betweens of two keyframes.
Out: enclosures of k, σ_a and σ_b, of a whole segment or one frame, and the times where the
enclosures are not tight.
Imports: `engine.maps`, `engine.interpolation.enclosures`, `engine.interpolation.inbetweens`.
"""
