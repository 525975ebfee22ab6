"""From pixels to a domain (Section 7; Chen and Weber 2015).

In: a picture, uint8 (h, w, 4).
Out: a `Domain`: outline, cage and triangulation in the picture's pixels, y up; and where handles
are useful in it.
Imports: `engine.geometry`.
"""

from engine.domain.build import (
    MOST_TRIANGLES,
    Domain,
    build_domain,
    mesh_inside,
    rectangle_domain,
    texture_coordinates,
)
from engine.domain.medial_axis import suggest_handles
from engine.domain.validity import MOST_MESH_TRIANGLES, require_domain

__all__ = [
    "MOST_MESH_TRIANGLES",
    "MOST_TRIANGLES",
    "Domain",
    "build_domain",
    "mesh_inside",
    "rectangle_domain",
    "require_domain",
    "suggest_handles",
    "texture_coordinates",
]
