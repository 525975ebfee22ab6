"""The medial axis of a shape: the middle between its sides, and the distance from them.

Its nodes are the triangles of the constrained Delaunay triangulation of a sampled boundary, each
linked to its neighbours. The circumcentres tend to the medial axis (Brandt and Algazi, "Continuous
skeleton computation by Voronoi diagram", 1992), and the links to its connectivity (Prasad,
"Morphological analysis of shapes", 1997).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.domain.meshing.mesh import sides_of
from engine.geometry import (
    Pieces,
    bisect_segments,
    constrained_delaunay,
    contains,
    corners_of,
    distance_to_boundary,
    edge_vectors,
)

# Of the length of the whole boundary: the longest of its segments that are triangulated.
STEP = 1 / 300
# Of the circumradius: least distance of the centre of an empty circle from the boundary. Samples
# miss parts of the boundary.
EMPTY = 0.7


class MedialAxis(NamedTuple):
    """A graph of n nodes in the middle of a shape; links (m, 2) are pairs of them.

    Radii are distances from the boundary, and gates (m,) half the widths of the openings that links
    lead through.
    """

    places: Complexes
    radii: Floats
    links: Indices
    gates: Floats


def medial_axis(loops: Sequence[Complexes]) -> MedialAxis:
    """Return the medial axis of a shape, with a spur into each convex corner.

    The loops are its outline, counter-clockwise, and those of its holes. A node stands for a
    triangle. It lies at the circumcentre, which is as far from the boundary as from the corners if
    the circle is empty. Where the samples are too sparse for that, it lies between the midpoints of
    the sides that the triangle shares. The triangulation has no inner points, so that without holes
    the graph is a tree. Vertices inside straight edges change nothing.
    """
    loops = [corners_of(loop) for loop in loops]
    step = STEP * sum(float(abs(edge_vectors(loop)).sum()) for loop in loops)

    def is_short(pieces: Pieces) -> Booleans:
        return np.asarray(pieces.lengths <= step)

    fine = [
        bisect_segments(Pieces.whole(loop, np.roll(loop, -1)), is_short).starts for loop in loops
    ]
    vertices = np.concatenate(fine)
    triangles = constrained_delaunay(fine[0], fine[1:])
    _, _, counterparts = sides_of(triangles)
    is_shared = np.zeros(triangles.size, dtype=np.bool_)
    is_shared[counterparts] = True
    places = _between_shared_sides(vertices[triangles], is_shared.reshape(-1, 3))
    radii = distance_to_boundary(loops[0], places, loops[1:])
    centres, apart = _circumcircles(vertices[triangles])
    inside = np.flatnonzero(contains(loops[0], centres, holes=loops[1:]))
    depth = distance_to_boundary(loops[0], centres[inside], loops[1:])
    is_empty = depth >= EMPTY * apart[inside]
    places[inside[is_empty]], radii[inside[is_empty]] = centres[inside[is_empty]], depth[is_empty]
    sides = np.roll(vertices[triangles], -1, 1) - vertices[triangles]
    return MedialAxis(
        places, radii, counterparts // 3, np.abs(sides.ravel()[counterparts[:, 0]]) / 2
    )


def _between_shared_sides(corners: Complexes, is_shared: Booleans) -> Complexes:
    """Return the mean of the midpoints of the sides that triangles (t, 3) share, (t,)."""
    middles = (corners + np.roll(corners, -1, 1)) / 2
    places: Complexes = (middles * is_shared).sum(1) / np.maximum(is_shared.sum(1), 1)
    return places


def _circumcircles(corners: Complexes) -> tuple[Complexes, Floats]:
    """Return the centres (t,) and radii (t,) of the circles through the corners (t, 3)."""
    b, c = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = 2 * (b.conj() * c).imag
    centres = 1j * (abs(b) ** 2 * c - abs(c) ** 2 * b) / np.where(area == 0, np.nan, -area)
    centres = np.where(np.isfinite(centres), centres, 0)
    return corners[:, 0] + centres, np.abs(centres)
