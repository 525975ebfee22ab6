"""The variants of the paper: each derives an in-between's derivatives from the keyframes'.

In: a keyframe segment; for the metric variant the Hilbert transform of the outline.
Out: f_z, conj(f_z̄) and their derivatives at any time; the blended quantities and their distortion.
Imports: `engine.dirichlet`, `engine.interpolation.keyframe_blend`,
`engine.interpolation.enclosures`, `engine.interpolation.scaling`,
`engine.interpolation.time_weights`, `engine.interpolation.added`.
"""
