"""The rigid part at the end of a limb: a foot, a hand, or a head.

The last bone leads into it. It begins at the neck, the narrowest place of the limb near the end of
this bone: an ankle, a wrist. What a cut across the neck separates from the bone's root is the end
part.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely

from engine.arrays import Complexes, readonly
from engine.domain.material.limb import measure_distances, spread_points
from engine.geometry import as_xy, shapely_region

# The neck lies in this last part of the bone's length, and is as far on as it is about as narrow.
NEAR_END, AS_NARROW = 0.35, 1.1
STATIONS = 36
LAST_STATION = 0.99
POINTS = 40
FEWEST_POINTS = 4
# The drawing bends near the neck: points of the end part keep away by these half widths.
CLEAR = 0.6
# A part that reaches less far from the end, in half widths of the neck, is none: a tail's tip. One
# that reaches farther than this many lengths of the bone is none: the rest of a tail. One that is
# wider than its neck may reach farther: a head.
LEAST_REACH, MOST_REACH = 1.05, 1.3
MOST_WIDE_REACH, WIDE = 2.0, 1.5
SPACING = 0.25  # of the outline's points, in half widths of the neck


class EndPart(NamedTuple):
    """The rigid part at the end of a limb.

    Parameters
    ----------
    neck : float
        Where the part begins, as a share of the last bone's length.
    points : complex128
        On the part's outline, clear of the neck.
    """

    neck: float
    points: Complexes


def find_end_part(
    loops: Sequence[Complexes], start: complex, end: complex, others: Sequence[complex] = ()
) -> EndPart | None:
    """Return the rigid part at the end of a limb's last bone; None if the limb ends there.

    A part that contains one of the `others`, places of handles, is none: they bend it.
    """
    way = end - start
    shares = np.linspace(1 - NEAR_END, LAST_STATION, STATIONS)
    left, right = measure_distances(loops, start, end, shares)
    widths = left + right
    if not np.isfinite(widths).any():
        return None
    last = int(np.flatnonzero(widths <= AS_NARROW * np.nanmin(widths))[-1])
    neck, half_width = float(shares[last]), float(widths[last]) / 2
    foot, aside = start + neck * way, 1j * way / abs(way)
    line = np.array([foot + 1.01 * left[last] * aside, foot - 1.01 * right[last] * aside])
    cut = shapely.LineString(as_xy(line)).buffer(1e-3 * half_width)
    parts = shapely.get_parts(shapely_region(loops[0], loops[1:]).difference(cut))
    own, root = (
        int(np.argmin([shapely.distance(part, shapely.Point(z.real, z.imag)) for part in parts]))
        for z in (end, start)
    )
    if own == root:
        return None
    outline = np.concatenate([_resampled(loop, SPACING * half_width) for loop in loops])
    places = shapely.points(as_xy(outline))
    nearest = np.argmin([shapely.distance(part, places) for part in parts], axis=0)
    away = shapely.distance(shapely.LineString(as_xy(line)), places)
    part = outline[(nearest == own) & (away > CLEAR * half_width)]
    if len(part) < FEWEST_POINTS or not _is_end(part - end, half_width, way):
        return None
    if any(parts[own].covers(shapely.Point(z.real, z.imag)) for z in others):
        return None
    return EndPart(neck, readonly(part[spread_points(part, POINTS)]))


def _resampled(loop: Complexes, spacing: float) -> Complexes:
    """Return points of a loop, at most so far apart."""
    sides = np.roll(loop, -1) - loop
    counts = np.ceil(np.maximum(np.abs(sides) / spacing, 1.0)).astype(np.intp)
    numbers = np.repeat(np.arange(len(loop)), counts)
    steps = np.arange(len(numbers)) - np.repeat(np.cumsum(counts) - counts, counts)
    points: Complexes = loop[numbers] + steps / counts[numbers] * sides[numbers]
    return points


def _is_end(ways: Complexes, half_width: float, bone: complex) -> bool:
    """Return whether points at these ways from the end are neither a tip nor most of a limb."""
    local = ways / bone * abs(bone)
    is_wide = float(np.ptp(local.imag)) > WIDE * 2 * half_width
    most = MOST_WIDE_REACH if is_wide else MOST_REACH
    least = max(float(local.real.max()), float(np.abs(local.imag).max()))
    return least > LEAST_REACH * half_width and float(np.abs(ways).max()) < most * abs(bone)
