"""From pixels to a domain (Section 7; Chen and Weber 2015).

In: a picture, uint8 (h, w, 4), and what tells its subject from the rest.
Out: a `Domain`: outlines, cages and triangulation in the picture's pixels, y up; the texture that
    is painted on it, and where handles are useful in it.
Imports: `engine.geometry`.
"""

from engine.domain.build import (
    MOST_TRIANGLES,
    Domain,
    build_domain,
    mesh_inside,
    rectangle_domain,
    texture,
    texture_coordinates,
)
from engine.domain.medial_axis import suggest_handles
from engine.domain.outline import HoleMap, find_holes
from engine.domain.picture import MOST_STROKE_POINTS, CutOut, Mask, Stroke, Subject, subject_mask
from engine.domain.validity import MOST_MESH_TRIANGLES, require_domain

__all__ = [
    "MOST_MESH_TRIANGLES",
    "MOST_STROKE_POINTS",
    "MOST_TRIANGLES",
    "CutOut",
    "Domain",
    "HoleMap",
    "Mask",
    "Stroke",
    "Subject",
    "build_domain",
    "find_holes",
    "mesh_inside",
    "rectangle_domain",
    "require_domain",
    "subject_mask",
    "suggest_handles",
    "texture",
    "texture_coordinates",
]
