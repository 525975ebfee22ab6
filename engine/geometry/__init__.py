"""Plane geometry of closed polygons, for every room above.

In: polygons by their vertices, and points.
Out: samples, distances, areas, and whether something is inside.
Imports: `engine.arrays`, `engine.errors`.
"""

from engine.geometry.polygon import (
    as_xy,
    box_diagonal,
    contains,
    deepest_point,
    diameter,
    distance_to_boundary,
    distance_to_segments,
    edges,
    require_simple,
    sample_graded,
    signed_area,
)

__all__ = [
    "as_xy",
    "box_diagonal",
    "contains",
    "deepest_point",
    "diameter",
    "distance_to_boundary",
    "distance_to_segments",
    "edges",
    "require_simple",
    "sample_graded",
    "signed_area",
]
