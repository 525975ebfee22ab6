"""The cage: a polygon around the outline, vertex for vertex (Weber et al. 2009, offset cages)."""

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, readonly
from engine.domain.outline.crossings import find_crossing_edges, find_meeting_edges
from engine.domain.outline.curve import arc_lengths, limit_growth
from engine.domain.outline.gaps import empty_disc_radius
from engine.errors import EngineError
from engine.geometry import diameter, distance_to_boundary, edge_vectors, require_simple

MITER_LIMIT = 2.0  # of the offset: how far a sharp corner of the cage stands out
ROOM = 0.7  # of the way to the middle of a gap
LEAST_DISTANCE = 0.0003  # of the diameter
LEAST_ALONG = 0.1  # cosine between an edge of the cage and of the outline
SLOPE = 0.5  # largest change of the offset per length of an edge
SHRINKING = 0.8
MOST_ROUNDS = 60
CLOSE_OUTLINE = (
    "The outline comes too close to itself for a cage around its {count} vertices. Choose a "
    "coarser detail, or widen the gap in the picture."
)


def offset_cage(outline: Complexes, offset: float, *, hole: bool = False) -> Complexes:
    """Return the cage around an outline, or inside that of a hole.

    Each vertex of the outline is moved outwards, so that the adjacent edges move by `offset`. The
    displacement is less at very sharp corners, and where the cage would meet itself.

    Parameters
    ----------
    outline : complex128, shape (n,)
        Simple, counter-clockwise, or clockwise around a hole.
    offset : float
        In the units of the outline.
    hole : bool
        Whether the domain lies around the outline, and the cage inside.

    Returns
    -------
    complex128, shape (n,)
        Simple, in the direction of the outline, strictly on the side away from the domain, nowhere
        closer to the outline than 0.03 % of its diameter.

    Raises
    ------
    EngineError
        If the outline is not simple and counter-clockwise, the offset is not positive, or the
        outline comes too close to itself to leave room for a cage.
    """
    require_simple(outline, "outline", clockwise=hole)
    if not offset > 0:
        raise EngineError("The cage's offset must be positive, not {offset}.", offset=offset)
    directions, arcs = _miters(outline), arc_lengths(outline)
    offsets = np.minimum(offset, ROOM * _room_outside(outline, directions))
    for _ in range(MOST_ROUNDS):
        offsets = limit_growth(offsets, arcs, SLOPE)
        cage = outline + offsets * directions
        faulty = _faulty_edges(outline, cage)
        if not faulty.any():
            break
        offsets[faulty | np.roll(faulty, 1)] *= SHRINKING
    # Two polygons that do not cross are closest at a vertex of one of them.
    ways = distance_to_boundary(outline, cage), distance_to_boundary(cage, outline)
    if faulty.any() or np.min(ways) < LEAST_DISTANCE * diameter(outline):
        raise EngineError(CLOSE_OUTLINE, count=len(outline))
    return readonly(cage)


def _miters(outline: Complexes) -> Complexes:
    """Return each vertex's displacement that moves both its edges outwards by 1, limited."""
    direction = edge_vectors(outline)
    normal = -1j * direction / np.abs(direction)
    both = normal + np.roll(normal, 1)
    # both / (|both|² / 2) has the component 1 along both normals.
    miter = 2 * both / np.maximum(np.abs(both) ** 2, 1e-12)
    return np.asarray(miter * np.minimum(1, MITER_LIMIT / np.abs(miter)))


def _room_outside(outline: Complexes, directions: Complexes) -> Floats:
    """Return the largest offset at each vertex (n,) before it fills half a gap.

    Two edges come closest at a vertex of one of them, so vertices against edges are enough.
    """
    along = edge_vectors(outline)
    to_start = outline[None, :] - outline[:, None]
    parameter = np.clip(-(to_start * along.conj()).real / np.abs(along) ** 2, 0, 1)
    across = to_start + parameter * along  # from vertex to the nearest point of each edge
    outside = (along.conj() * to_start).imag > 0
    normals = directions / np.abs(directions)
    radius = np.where(outside, empty_disc_radius(normals[:, None], across), np.inf)
    here = np.arange(len(outline))
    radius[here, here] = radius[here, here - 1] = np.inf  # a vertex's own edges
    half = np.where(np.isfinite(radius), np.abs(across) / 2, np.inf)
    # A convex vertex itself approaches the other side; in a notch its edges do.
    convex = (np.roll(along, 1).conj() * along).imag > 0
    at_vertex = np.where(convex, radius.min(axis=1) / np.abs(directions), half.min(axis=1))
    # Farther from the gap's narrowest place, an end of the edge may keep more.
    start_room = (radius + SLOPE * parameter * np.abs(along)).min(axis=0)
    end_room = (radius + SLOPE * (1 - parameter) * np.abs(along)).min(axis=0)
    return np.asarray(np.minimum(at_vertex, np.minimum(start_room, np.roll(end_room, 1))))


def _faulty_edges(outline: Complexes, cage: Complexes) -> Booleans:
    """Mark the edges (n,) of the cage that run backwards, or meet the cage or the outline."""
    along, moved = edge_vectors(outline), edge_vectors(cage)
    turned = (moved * along.conj()).real <= LEAST_ALONG * np.abs(along) * np.abs(moved)
    touching, touched = find_meeting_edges(cage, outline)
    return np.asarray(turned | find_crossing_edges(cage) | touching | touched)
