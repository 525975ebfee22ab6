"""Plane geometry of segments and closed polygons, for every room above.

In: polygons by their vertices, segments by their ends, and points.
Out: samples, pieces, triangles, distances, areas, and whether something is inside.
Imports: `engine.arrays`, `engine.errors`.
"""

from engine.geometry.hole import Hole, require_cages_in_holes
from engine.geometry.polygon import (
    as_xy,
    box_diagonal,
    constrained_delaunay,
    contains,
    deepest_point,
    diameter,
    distance_to_boundary,
    edges,
    lies_within,
    loop_ends,
    next_on_loop,
    region,
    require_around,
    require_holes,
    require_inside,
    require_simple,
    sample_graded,
    signed_area,
    winding,
)
from engine.geometry.segments import Pieces, bisect, distance_to_segments

__all__ = [
    "Hole",
    "Pieces",
    "as_xy",
    "bisect",
    "box_diagonal",
    "constrained_delaunay",
    "contains",
    "deepest_point",
    "diameter",
    "distance_to_boundary",
    "distance_to_segments",
    "edges",
    "lies_within",
    "loop_ends",
    "next_on_loop",
    "region",
    "require_around",
    "require_cages_in_holes",
    "require_holes",
    "require_inside",
    "require_simple",
    "sample_graded",
    "signed_area",
    "winding",
]
