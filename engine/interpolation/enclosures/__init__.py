"""Enclosures of the blended quantities along pieces of the boundary and pieces of time.

In: keyframes and a boundary.
Out: `EndpointValues` and `BoundaryBezier`, the keyframes along pieces; `BernsteinPatch` and
`BilinearPatch`, quantities on cells; enclosures of k, σ_a and σ_b on cells.
Imports: `engine.maps`.
"""
