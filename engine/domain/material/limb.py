"""The limb around a bone, without its joints.

A bone is a line in the drawing. At places along the bone, the outline has a distance on either
side. A limb is about equally thick along most of the bone. Much larger distances, where the bone
enters the trunk, do not belong to the limb.
"""

from collections.abc import Sequence

import numpy as np
import shapely

from engine.arrays import Booleans, Complexes, Floats, as_points
from engine.errors import EngineError
from engine.geometry import ON_OUTLINE, as_xy, diameter, shapely_region

# Places along a bone at which its limb is measured.
PLACES = 48
# The half width on each side is this quantile of the places' distances. Points up to so many times
# the half width belong to the limb; from there to the last factor the share falls to 0.
USUAL, THICKEST, BEYOND = 0.4, 1.35, 1.8
# Length of the joint at each end, over the limb's half width, and at most over its length.
# Measured: with 1 an arm rotates at its shoulder by less than half as far.
JOINT, LONGEST_JOINT = 1.6, 0.42
BONE_STAYS = (
    "The bone leaves the drawing or crosses a hole. Add a handle between its ends, and a bone "
    "on each side of that handle."
)


def limb_weights(
    loops: Sequence[Complexes], start: complex, end: complex, points: Complexes
) -> Floats:
    """Return the share of a bone's stiffness at points of a drawing's boundary (t,), 0 to 1.

    A point belongs to the limb if it is beside the bone, visible from it, and not much farther away
    than the limb is thick. Towards both ends the share falls smoothly to 0: joints bend.

    Parameters
    ----------
    loops : sequence of complex128
        The outline, and those of holes.
    start, end : complex
        The ends of the bone, in the closed domain.

    Raises
    ------
    EngineError
        If the bone has no length, leaves the drawing or crosses a hole.
    """
    area = require_bone(loops, start, end)
    length = abs(end - start)
    local = (points - start) * np.conj(end - start) / length
    along, across = local.real / length, local.imag
    widths = measure_half_widths(loops, start, end)
    joint = min(JOINT * float(widths.mean()), LONGEST_JOINT * length) / length
    shares = _smooth(np.minimum(along, 1 - along) / joint)
    width = np.where(across > 0, widths[0], widths[1])
    shares *= np.clip((BEYOND - np.abs(across) / width) / (BEYOND - THICKEST), 0.0, 1.0)
    beside = np.flatnonzero(shares > 0)
    feet = start + along[beside] * (end - start)
    shares[beside] *= _sees(area, feet, points[beside])
    return shares


def require_bone(loops: Sequence[Complexes], start: complex, end: complex) -> shapely.Geometry:
    """Return the drawing with a little room around it, or raise an `EngineError`.

    A bone has a length, and it stays in the drawing without crossing a hole.
    """
    as_points([start, end], "The ends of a bone")
    area = shapely_region(loops[0], loops[1:]).buffer(ON_OUTLINE * diameter(loops[0]))
    if not abs(end - start) > 0:
        raise EngineError("A bone must connect two different points.")
    bone = shapely.LineString([(start.real, start.imag), (end.real, end.imag)])
    if not area.covers(bone):
        raise EngineError(BONE_STAYS)
    return area


def measure_half_widths(loops: Sequence[Complexes], start: complex, end: complex) -> Floats:
    """Return the half width of the limb to the left and to the right of a bone, float64 (2,)."""
    shares = (np.arange(PLACES) + 0.5) / PLACES
    distances = measure_distances(loops, start, end, shares)
    found: Floats = np.nanquantile(distances, USUAL, axis=1)
    return np.maximum(found, ON_OUTLINE * diameter(loops[0]))


def measure_distances(
    loops: Sequence[Complexes], start: complex, end: complex, shares: Floats
) -> Floats:
    """Return how far the outline is from places along a bone, float64 (2, s): left and right.

    NaN where there is none.
    """
    outlines = shapely.MultiLineString([shapely.LinearRing(as_xy(loop)) for loop in loops])
    shapely.prepare(outlines)
    feet = np.asarray(start + shares * (end - start), np.complex128)
    aside = 1j * (end - start) / abs(end - start) * diameter(loops[0])
    found = []
    for direction in (aside, -aside):
        rays = np.column_stack([feet, feet + direction])
        hits = shapely.intersection(shapely.linestrings(rays.real, rays.imag), outlines)
        found.append(shapely.distance(shapely.points(as_xy(feet)), hits))
    return np.array(found)


def spread_points(points: Complexes, count: int) -> list[int]:
    """Return the indices of at most so many points that are far from each other."""
    if len(points) == 0:
        return []
    chosen = [0]
    distances = np.abs(points - points[0])
    while len(chosen) < min(count, len(points)):
        chosen.append(int(np.argmax(distances)))
        distances = np.minimum(distances, np.abs(points - points[chosen[-1]]))
    return chosen


def _smooth(depth: Floats) -> Floats:
    """Return a smooth step from 0 to 1 over depths from 0 to 1."""
    share = np.clip(depth, 0.0, 1.0)
    step: Floats = share * share * (3 - 2 * share)
    return step


def _sees(area: shapely.Geometry, feet: Complexes, points: Complexes) -> Booleans:
    """Whether the straight line from each foot to its point is inside."""
    shapely.prepare(area)
    lines = np.column_stack([feet, points])
    seen = shapely.covers(area, shapely.linestrings(lines.real, lines.imag))
    return np.asarray(seen, dtype=np.bool_)
