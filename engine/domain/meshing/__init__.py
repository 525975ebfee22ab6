"""From an outline to a near-equilateral triangulation inside it, in the order of painting.

In: a simple polygon and a number of triangles.
Out: a `Mesh`; the sides of its triangles.
Imports: `engine.geometry`.
"""
