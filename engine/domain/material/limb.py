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
    as_points([start, end], "The ends of a bone")
    length = abs(end - start)
    area = shapely_region(loops[0], loops[1:]).buffer(ON_OUTLINE * diameter(loops[0]))
    if not length > 0:
        raise EngineError("A bone must connect two different points.")
    bone = shapely.LineString([(start.real, start.imag), (end.real, end.imag)])
    if not area.covers(bone):
        raise EngineError(BONE_STAYS)
    local = (points - start) * np.conj(end - start) / length
    along, across = local.real / length, local.imag
    widths = _widths(loops, start, end)
    joint = min(JOINT * float(widths.mean()), LONGEST_JOINT * length) / length
    shares = _smooth(np.minimum(along, 1 - along) / joint)
    width = np.where(across > 0, widths[0], widths[1])
    shares *= np.clip((BEYOND - np.abs(across) / width) / (BEYOND - THICKEST), 0.0, 1.0)
    beside = np.flatnonzero(shares > 0)
    feet = start + along[beside] * (end - start)
    shares[beside] *= _sees(area, feet, points[beside])
    return shares


def _widths(loops: Sequence[Complexes], start: complex, end: complex) -> Floats:
    """Return the width of the limb to the left and to the right of the bone."""
    outlines = shapely.MultiLineString([shapely.LinearRing(as_xy(loop)) for loop in loops])
    shapely.prepare(outlines)
    feet = np.array(start + (np.arange(PLACES) + 0.5) / PLACES * (end - start), complex)
    size = diameter(loops[0])
    aside = 1j * (end - start) / abs(end - start) * size
    found = []
    for direction in (aside, -aside):
        rays = np.column_stack([feet, feet + direction])
        hits = shapely.intersection(shapely.linestrings(rays.real, rays.imag), outlines)
        distances = shapely.distance(shapely.points(as_xy(feet)), hits)
        found.append(np.nanquantile(distances, USUAL))
    return np.maximum(found, ON_OUTLINE * size)


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
