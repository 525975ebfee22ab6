"""Stiffness of a drawing: limbs around bones, brush strokes, and transfer to a new outline.

In: the loops of a domain, and places in it.
Out: shares from 0 to 1 along the loops, and stiffnesses there.
Imports: `engine.geometry`.
"""
