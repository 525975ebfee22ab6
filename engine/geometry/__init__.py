"""Plane geometry of segments, closed polygons and domains, for every room above.

In: polygons by their vertices, segments by their ends, and points.
Out: samples, pieces, triangles, distances, areas, and tests of being inside.
Imports: `engine.arrays`, `engine.errors`.
"""

from engine.geometry.best_rigid import fit_rigid as fit_rigid
from engine.geometry.domain import Domain as Domain
from engine.geometry.hole import Hole as Hole, require_cages_in_holes as require_cages_in_holes
from engine.geometry.polygon import (
    ON_OUTLINE as ON_OUTLINE,
    SIZES as SIZES,
    as_xy as as_xy,
    box_diagonal as box_diagonal,
    constrained_delaunay as constrained_delaunay,
    contains as contains,
    corners_of as corners_of,
    crossings_at as crossings_at,
    deepest_point as deepest_point,
    diameter as diameter,
    distance_to_boundary as distance_to_boundary,
    edge_vectors as edge_vectors,
    lies_within as lies_within,
    loop_ends as loop_ends,
    next_on_loop as next_on_loop,
    require_around as require_around,
    require_holes as require_holes,
    require_inside as require_inside,
    require_simple as require_simple,
    sample_graded as sample_graded,
    shapely_region as shapely_region,
    signed_area as signed_area,
    winding_number as winding_number,
)
from engine.geometry.segments import (
    Pieces as Pieces,
    arc_lengths as arc_lengths,
    bisect_segments as bisect_segments,
    distance_to_segments as distance_to_segments,
)
from engine.geometry.similarity import (
    IDENTITY_MOTION as IDENTITY_MOTION,
    Similarity as Similarity,
)
from engine.geometry.triangles import barycentric_weights as barycentric_weights
