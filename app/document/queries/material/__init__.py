"""Stiffness and limits along a layer's outline, from paint and bones.

In: a layer, and the boundary of its domain.
Out: stiffness, limits, and the drawing around bones.
Imports: the values of `app.document`.
"""
