"""The motion of a clip at given points: in-betweens, auto-pins, tracks and springs.

In: a clip and points.
Out: positions at any frame, with f_z and f_z̄.
Imports: `app.document`, `app.errors`.
"""
