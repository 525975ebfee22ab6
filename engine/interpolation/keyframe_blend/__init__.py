"""Keyframes at a sampled domain, and the part of the blend that all variants share.

In: harmonic maps, a sampled domain, time weights.
Out: log f_z of in-betweens, and the samples and weight of each keyframe.
Imports: `engine.interpolation.time_weights`, `engine.interpolation.series`,
`engine.interpolation.sampled_domain`.
"""
