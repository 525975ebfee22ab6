"""The rigid parts of a drawing with bones: points on the axis of each bone, and of the body.

A bone's shaft lies where the drawing is a limb, narrower than the bone is long, and keeps clear of
the joints, which bend. Two points beside its middle hold the limb's width. The body is what lies on
the root's side of a cut across each limb.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely

from engine.arrays import Booleans, Complexes, Floats, readonly
from engine.domain.material.end_parts import EndPart
from engine.domain.material.limb import (
    measure_distances,
    measure_half_widths,
    require_bone,
    spread_points,
)
from engine.geometry import (
    as_xy,
    contains,
    deepest_point,
    distance_to_boundary,
    shapely_region,
)

POINTS = 5  # on the axis of a bone
BODY_POINTS = 200
LATTICE = 64  # places along the longer side among which the body's anchor is chosen
# Near a root the body bends with the limb: its points are firm from this many half widths of the
# joint on, but never more than this part of them is not. Measured on stubs: with all points firm a
# bend of 100° moved parts of the body by 8 to 24 thousandths, and with these by 1 to 8.
BESIDE_ROOT, MOST_BESIDE = 3.0, 0.35
# Largest share beside a root; nearer it falls with the square of the distance. Measured on 12
# limbs: without it places two half widths from a root moved by 17 to 119 thousandths, such as
# heads beside shoulders, and with it by 2 to 29. Twice as much holds trunks back that should bend.
BESIDE_SHARE = 0.05
# A shaft keeps clear of a joint by this many half widths, and by at most this part of the bone.
CLEAR, MOST_CLEAR = 0.9, 0.4
# The drawing is a limb where it is narrower than this part of the bone's length.
NARROW = 0.95
# The body ends where the limb is first at most so many times as wide as where it is narrowest.
AS_NARROW = 1.3
# From this part of the first bone on, points within so many half widths belong to the limb.
THIGH, BESIDE_THIGH = 0.2, 1.7
# Half widths count as at most this part of the length: a trunk is no limb.
WIDEST = 0.35
# The same for joints: a leg as thick as long bends all along.
WIDEST_JOINT = 0.7
BEYOND_JOINT = 2.5  # half widths; one less is fully part of the joint
SHORTEST_SHAFT = 0.15  # part of the bone's length
# Where the width of a limb is held: so much of the way from the bone to the outline.
WITHIN_WIDTH = 0.6
STATIONS = 49  # places along a bone at which the drawing's width is measured
FEWEST_STATIONS = 5
INSET = 0.02  # part of the length without stations at each end


class LimbShape(NamedTuple):
    """The drawing around a bone.

    `half_widths` are those to the left and to the right, in pixels. `joint_width` is their mean for
    joints, which counts more of a thick limb. `limb_range` says from where to where the bone lies
    in a limb, as parts of its length. `end_part` is the rigid part at the end of a last bone.
    """

    half_widths: Floats
    joint_width: float
    limb_range: tuple[float, float]
    stations: Floats
    end_part: EndPart | None = None

    @property
    def half_width(self) -> float:
        return float(self.half_widths.mean())

    @property
    def root_shares(self) -> list[float]:
        """Where the limb bends at its root and where it leaves the body, as shares of the bone."""
        return [0.0, self.limb_range[0]]

    def bending_shares(self, *, has_joint: bool) -> list[float]:
        """Return where the limb bends at its end: at a joint, or at the neck of its end part."""
        if has_joint:
            return [1.0]
        return [] if self.end_part is None else [self.end_part.neck]


def measure_limb(loops: Sequence[Complexes], start: complex, end: complex) -> LimbShape:
    """Measure the drawing around a bone.

    Raises
    ------
    EngineError
        If the bone has no length, leaves the drawing or crosses a hole.
    """
    require_bone(loops, start, end)
    length = abs(end - start)
    drawn = measure_half_widths(loops, start, end)
    widths = np.minimum(drawn, WIDEST * length)
    joint_width = min(float(drawn.mean()), WIDEST_JOINT * length)
    shares = np.linspace(INSET, 1 - INSET, STATIONS)
    left, right = measure_distances(loops, start, end, shares)
    across = left + right
    is_inside = across < NARROW * length
    inside = shares[is_inside]
    found = (float(inside[0]), float(inside[-1])) if len(inside) >= FEWEST_STATIONS else (0.4, 0.6)
    # Narrow stations in the limb come first: a cut across the trunk parts more than the limb.
    narrow = inside[across[is_inside] < AS_NARROW * across[is_inside].min(initial=np.inf)]
    return LimbShape(widths, joint_width, found, np.concatenate([narrow, inside, shares]))


def shaft_points(limb: LimbShape, start: complex, end: complex, *, is_last: bool) -> Complexes:
    """Return the points of a bone's shaft; the last bone of a chain has no joint at its end."""
    length = abs(end - start)
    clear = min(CLEAR * limb.half_width / length, MOST_CLEAR)
    low = max(clear, limb.limb_range[0])
    if limb.end_part is not None:
        high = limb.end_part.neck - clear
    else:
        high = 1.0 if is_last else min(1 - clear, limb.limb_range[1])
    low = min(low, high - SHORTEST_SHAFT)
    points = start + np.linspace(low, high, POINTS) * (end - start)
    return readonly(np.asarray(points, np.complex128))


def width_points(
    loops: Sequence[Complexes], start: complex, end: complex, middle: complex
) -> Complexes:
    """Return two points in the limb, to the left and to the right of a bone at a place on it."""
    way = (end - start) / abs(end - start)
    share = ((middle - start) / (end - start)).real
    left, right = measure_distances(loops, start, end, np.array([share]))[:, 0]
    most = WIDEST * abs(end - start)
    aside = WITHIN_WIDTH * np.array([min(left, most), -min(right, most)])
    return readonly(np.asarray(middle + 1j * way * aside, np.complex128))


class LimbCut(NamedTuple):
    """A limb that is no part of the body: its first bone, and the end of its last bone."""

    root: complex
    joint: complex
    end: complex
    shape: LimbShape


class BodyPoints(NamedTuple):
    """Points of the outline (≤ `BODY_POINTS` each) that belong to no limb, far from each other.

    Those `beside` the roots of limbs give way where a limb bends at its root: they have shares
    below 1 of the others' firmness.
    """

    firm: Complexes
    beside: Complexes
    shares: Floats


def body_points(
    loops: Sequence[Complexes], candidates: Complexes, limbs: Sequence[LimbCut]
) -> BodyPoints:
    """Return points of the body among candidates on the outline; `limbs` as in `is_in_body`."""
    left = candidates[is_in_body(loops, candidates, limbs)]
    shares = np.ones(len(left))
    if len(left) and limbs:
        from_roots = [np.abs(left - limb.root) / limb.shape.joint_width for limb in limbs]
        away = np.min(from_roots, axis=0)
        firm_from = min(BESIDE_ROOT, float(np.quantile(away, MOST_BESIDE)))
        shares = np.where(away < firm_from, BESIDE_SHARE * (away / firm_from) ** 2, 1.0)
    firm, beside = left[shares >= 1.0], np.flatnonzero(shares < 1.0)
    beside = beside[spread_points(left[beside], BODY_POINTS)]
    return BodyPoints(
        firm=readonly(firm[spread_points(firm, BODY_POINTS)]),
        beside=readonly(left[beside]),
        shares=readonly(shares[beside]),
    )


def body_anchor(loops: Sequence[Complexes], limbs: Sequence[LimbCut]) -> complex | None:
    """Return a place deep in the body; None if that is where the drawing is deepest of all.

    A body without a place is a cap at the root of its only limb, which is returned.
    """
    outline, *holes = loops
    deepest = np.array([deepest_point(outline, holes)])
    if is_in_body(loops, deepest, limbs)[0]:
        return None
    width, height = np.ptp(outline.real), np.ptp(outline.imag)
    step = max(width, height) / LATTICE
    x, y = (np.arange(step / 2, side, step) for side in (width, height))
    places = outline.real.min() + 1j * outline.imag.min() + (x[:, None] + 1j * y).ravel()
    places = places[contains(outline, places, holes=holes)]
    places = places[is_in_body(loops, places, limbs)]
    if not len(places):
        return limbs[0].root
    return complex(places[distance_to_boundary(outline, places, holes).argmax()])


def is_in_body(loops: Sequence[Complexes], points: Complexes, limbs: Sequence[LimbCut]) -> Booleans:
    """Return for points of the drawing whether they belong to no limb.

    A limb that no cut separates from its root gets all that is beside its first bone.
    """
    whole, places = shapely_region(loops[0], loops[1:]), shapely.points(as_xy(points))
    is_body = np.ones(len(points), dtype=np.bool_)
    for limb in limbs:
        way = limb.joint - limb.root
        along = ((points - limb.root) * np.conj(way)).real / abs(way) ** 2
        away = np.abs(points - limb.root - np.clip(along, 0, 1) * way)
        beside = np.where(along > THIGH, BESIDE_THIGH, 1.0)
        is_body &= away > beside * limb.shape.half_widths.max()
        parts = _cut_limb(loops, whole, limb)
        if parts is not None:
            own = _nearest_part(parts, limb.end)
            distances = [shapely.distance(part, places) for part in parts]
            is_body &= np.argmin(distances, axis=0) != own
    return is_body


def larger_end(loops: Sequence[Complexes], start: complex, end: complex) -> int:
    """Return the end of a bone, 0 or 1, on whose side more of the drawing lies."""
    shape = measure_limb(loops, start, end)
    middle_first = shape.stations[np.argsort(np.abs(shape.stations - 0.5))]
    limb = LimbCut(start, end, end, shape._replace(stations=middle_first))
    parts = _cut_limb(loops, shapely_region(loops[0], loops[1:]), limb)
    if parts is None:
        return 0
    areas = [parts[_nearest_part(parts, place)].area for place in (start, end)]
    return int(areas[1] > areas[0])


def joint_share(points: Complexes, place: complex, half_width: float) -> Floats:
    """Return how much points belong to a joint: 1 near it, and 0 beyond it.

    Inside a bend θ the outline gives way up to w tan(θ/2) along each bone of half width w.
    """
    depth = np.clip(BEYOND_JOINT - np.abs(points - place) / half_width, 0.0, 1.0)
    share: Floats = depth * depth * (3 - 2 * depth)
    return share


def _cut_limb(
    loops: Sequence[Complexes], whole: shapely.Geometry, limb: LimbCut
) -> list[shapely.Geometry] | None:
    """Return the parts of the drawing after a cut that separates a limb's end from its root."""
    way = limb.joint - limb.root
    aside, thickness = 1j * way / abs(way), 1e-3 * abs(way)
    left, right = measure_distances(loops, limb.root, limb.joint, limb.shape.stations)
    for share, before, behind in zip(limb.shape.stations, left, right, strict=True):
        foot = limb.root + share * way
        ends = [foot + aside * (before + thickness), foot - aside * (behind + thickness)]
        if not np.isfinite(ends).all():
            continue
        cut = shapely.LineString(as_xy(np.array(ends))).buffer(thickness / 2)
        parts = list(shapely.get_parts(whole.difference(cut)))
        if _nearest_part(parts, limb.end) != _nearest_part(parts, limb.root):
            return parts
    return None


def _nearest_part(parts: Sequence[shapely.Geometry], place: complex) -> int:
    point = shapely.Point(place.real, place.imag)
    return int(np.argmin([shapely.distance(part, point) for part in parts]))
