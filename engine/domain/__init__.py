"""From a mask or a polygon to a meshed domain (Section 7; Chen and Weber 2015).

In: the mask of a subject, bool (h, w), or polygons.
Out: a `MeshedDomain`: outlines, cages and triangulation in the mask's pixels, y up.
Imports: `engine.geometry`.
"""

from engine.domain.build import (
    MOST_TRIANGLES as MOST_TRIANGLES,
    MeshedDomain as MeshedDomain,
    build_domain as build_domain,
    domain_of_polygon as domain_of_polygon,
    mesh_inside as mesh_inside,
    rectangle_domain as rectangle_domain,
    texture_coordinates as texture_coordinates,
)
from engine.domain.closed_cuts import ClosedCuts as ClosedCuts, find_closed_cuts as find_closed_cuts
from engine.domain.outline.holes import HoleMap as HoleMap, find_holes as find_holes
from engine.domain.outline.slit_sides import CUT_WIDTH as CUT_WIDTH
from engine.domain.validity import (
    MOST_MESH_TRIANGLES as MOST_MESH_TRIANGLES,
    require_domain as require_domain,
)
from engine.geometry import Domain as Domain
