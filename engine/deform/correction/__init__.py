"""Corrections of in-betweens, in the variables in which they are blended.

In: f_z and conj(f_z̄) of a frame at the nodes of paths to some points, and targets of the points.
Out: two holomorphic functions h and q that bring the points to their targets; the corrected frame's
distortion follows from moduli.
Imports: `engine.maps`, `engine.paths`.
"""
