"""The scaling ρ of η: by the pointwise rule of the paper (Section 7.3), and without kinks.

In: keyframes, an outline, time weights, bounds.
Out: the factor ρ at any time.
Imports: `engine.maps`, `engine.interpolation.time_weights.weights`, `engine.interpolation.added`.
"""
