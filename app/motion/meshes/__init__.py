"""Meshes that poses deform: their vertices in a frame, and the drawing order of their triangles.

In: a domain with its mesh, and poses or series.
Out: vertices with triangles from back to front.
Imports: `app.document`, `engine`.
"""
