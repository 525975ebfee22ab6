"""The near arm of a body seen from the side, drawn over the trunk.

Its contour lies inside the drawing: two lines from the shoulder down, joined around the hand, open
or closed at the shoulder; the hand may reach beyond the trunk. Of many guessed axes, the one with
the clearest contour is centred in it.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import shapely
from scipy import ndimage

from app.rigging.anatomy.lines.arm_rays import (
    OPEN,
    SEEN,
    ArmContours,
    ArmRaster,
    resample_axes,
    stretch_axes,
    trace_contours,
)
from app.rigging.motions.body import SIDES
from app.rigging.motions.kinds import near_side
from engine.arrays import Booleans, Bytes, Complexes, Floats
from engine.geometry import as_xy, box_diagonal, contains, shapely_region

ARM = ("shoulder", "elbow", "hand")
# Guessed axes: shoulders from the neck to the hips and beside this line, lengths of arms, all in
# lengths of the trunk; angles of arms in degrees forwards from straight down; bends of elbows
# backwards in lengths of the arm.
DOWN = (0.0, 0.1, 0.2, 0.3, 0.4)
ASIDE = (-0.2, -0.1, 0.0, 0.1, 0.2)
LONG = (0.55, 0.7, 0.85, 1.0, 1.2)
TURNED = (-25.0, -10.0, 0.0, 10.0, 25.0, 40.0, 60.0, 80.0)
BENT = (-0.2, -0.08, 0.05, 0.18, 0.33, 0.5)
COARSE, FINE = 420, 1200  # samples of the picture's longer side
# Rays on a side, rays around the hand, and samples along a ray, in the search and at last.
SEARCHED, TRACED = (16, 7, 26), (60, 21, 90)
STRETCHED = (0.0, 0.12, 0.3)  # shares by which axes are made longer at the hand, in turn
LESS_CLEAR = 0.04  # than the clearest contour, at most
HAND = 0.06  # of an arm's length: contours that end this near to each other reach equally far
RESTRETCHED = (-0.1, -0.05, 0.0, 0.06)  # the same for a known axis
CENTRED = 3  # times that an axis is centred
BEST = 6  # guesses that are centred
LONGER, LONGEST = 0.25, 1.2  # worth of an arm as long as the trunk; longer ones are worth no more
SURE = 0.82  # least clearness of a contour
SLENDER = 2.2  # length over width of an arm, at least: wings are thicker
THIN, BROAD = 0.6, 1.7  # of its usual width: least and most of an arm
THICK = 1.3  # of the usual width of a line: most of one
MOST_BACK = -45.0  # degrees forwards from straight down: least of an arm
GAP = 3  # rays of a gap in a line
STEADY, SMOOTHING = 5, 1.2  # rays: of a median, and of rounding
OUT = 0.02  # of the diagonal: how far outside the drawing the contour of a hand runs
CROSSING, LEAVING = 4, 5  # rays along the hand across the trunk's outline, and until it is there
BESIDE_INK = 1.2  # samples from the ink to the contour, as lines are blurred
MIDDLE = slice(16, 25)  # of 41 points of an arm: its elbow is one of them
STRAIGHT = 0.04  # of the arm's length: an elbow less beside a straight arm is in its middle
ROOM = 0.012  # of the diagonal: distance of joints from the arm that covers them, and from edges


class NearArm(NamedTuple):
    """An arm over the trunk.

    Parameters
    ----------
    contour : complex128, shape (n,)
        From the shoulder around the hand back to the shoulder, the arm on its right; beside the
        ink, so that the arm keeps its outline. Outside the drawing where the hand is beyond it.
    joints : tuple of complex
        Shoulder, elbow and hand.
    """

    contour: Complexes
    joints: tuple[complex, complex, complex]


def find_near_arm(
    loops: Sequence[Complexes],
    joints: Mapping[str, complex],
    facing: int,
    rgba: Bytes,
    corner: complex,
) -> NearArm | None:
    """Return the arm that is drawn over the trunk; None if no contour is sure.

    Parameters
    ----------
    loops : sequence of complex128
        The outline and the outlines of the holes; y up.
    joints : mapping of str to complex
        Of a body that stands on two legs, seen from the side.
    facing : int
        1 to the right, -1 to the left.
    rgba : uint8, shape (h, w, 4)
        The picture, transparent outside the drawing.
    corner : complex
        Its lower left corner.
    """
    if not {"hips", "chest"} <= joints.keys():
        return None
    top = joints.get("neck", (joints["chest"] + joints.get("head", joints["chest"])) / 2)
    tall = abs(joints["hips"] - top)
    if not tall:
        return None
    raster = ArmRaster.of(rgba, corner, COARSE)
    axes = resample_axes(raster.cells(_guess_axes(top, joints["hips"], facing)), SEARCHED[0])
    knees = [place.imag for name, place in joints.items() if name.startswith("knee")]
    lowest = (max(knees) - raster.corner.imag) / raster.factor if knees else 0.0
    axes = axes[raster.shows(axes).all(axis=1) & (axes[:, -1].imag > lowest)]
    if not len(axes):
        return None
    tall /= raster.factor
    found = _trace(raster, axes, SEARCHED)
    found = found.best(_score(found, tall), BEST)
    for _ in range(CENTRED):
        axes = found.centred()
        axes = np.concatenate([stretch_axes(axes, share) for share in STRETCHED])
        found = found.joined(_trace(raster, axes, SEARCHED))
        found = found.best(_score(found, tall), BEST)
    arm = trace_near_arm(loops, raster.places(found.axes[0]), rgba, corner)
    if arm is None:
        return None
    # A wing points backwards.
    turn = facing * float(np.angle((arm.joints[2] - arm.joints[0]) * 1j, deg=True))
    return arm if turn >= MOST_BACK else None


def trace_near_arm(
    loops: Sequence[Complexes], axis: Complexes, rgba: Bytes, corner: complex
) -> NearArm | None:
    """Return the arm around an axis (n,) from above its shoulder to the hand; None if not sure."""
    fine = ArmRaster.of(rgba, corner, FINE)
    ways = resample_axes(fine.cells(axis)[None], TRACED[0])
    ways = np.concatenate([stretch_axes(ways, share) for share in RESTRETCHED])
    found = _trace(fine, ways, TRACED)
    found = found.joined(_trace(fine, found.centred(), TRACED))
    # A line across the arm, as at the wrist, does not end it: the clearest of those that reach far.
    clearness, reach = found.clearness(), np.abs(found.axes[:, -1] - ways[0, 0])
    is_clear = clearness >= clearness.max() - LESS_CLEAR
    is_far = reach >= reach[is_clear].max() - HAND * reach.mean()
    found = found.best(np.where(is_clear & is_far, clearness, -np.inf), 1)
    is_sure = clearness.max() >= SURE and found.slenderness()[0] >= SLENDER
    return _placed(found, fine, loops) if is_sure else None


def _placed(found: ArmContours, fine: ArmRaster, loops: Sequence[Complexes]) -> NearArm:
    """Return the arm of a contour in samples."""
    count = found.axes.shape[1]
    seen, is_edge = found.seen[0], found.is_edge[0]
    widths = found.half_widths()[0]
    usual = np.median(widths[round(OPEN * count) :])
    is_arm = (widths > THIN * usual) & (widths < BROAD * usual)
    first = _first_seen((seen[:count] >= SEEN) & is_arm)
    last = len(seen) - 1 - _first_seen((seen[: -count - 1 : -1] >= SEEN) & is_arm)
    offsets = ndimage.median_filter(_beyond_ink(found, fine), STEADY, mode="nearest")
    offsets = ndimage.gaussian_filter1d(offsets[first : last + 1], SMOOTHING, mode="nearest")
    ways = found.starts[0, first : last + 1], found.steps[0, first : last + 1]
    # Of a hand beyond the trunk, it goes straight across the outline of the trunk, and then leaves.
    beyond = ndimage.distance_transform_edt(np.pad(is_edge[first : last + 1], 1))[1:-1]
    push = OUT * box_diagonal(loops[0]) * np.clip((beyond - CROSSING) / LEAVING, 0.0, 1.0)
    contour = fine.places(ways[0] + offsets * ways[1]) + push * ways[1] / np.abs(ways[1])
    shoulder = complex(contour[0] + contour[-1]) / 2
    middle = fine.places(found.midlines()[0])
    begin = min(first, len(seen) - 1 - last)
    way = middle[max(begin, 1) :]
    end = fine.places(found.axes[0, -1:])[0]
    way = resample_axes(
        np.concatenate([[shoulder], way[np.abs(way - shoulder) > 0], [end]])[None], 41
    )[0]
    chord = (way[-1] - way[0]) / abs(way[-1] - way[0])
    aside = np.abs(((way - way[0]) * chord.conj()).imag)[MIDDLE]
    at = (
        MIDDLE.start + int(aside.argmax()) if aside.max() > STRAIGHT * abs(way[-1] - way[0]) else 20
    )
    return NearArm(contour, (shoulder, complex(way[at]), complex(way[-1])))


def _first_seen(seen: Booleans) -> int:
    """Return the first ray from which on a line is seen, with short gaps, near the root."""
    first = round(OPEN * len(seen))
    for ray in range(first, -1, -1):
        if seen[ray]:
            first = ray
        elif first - ray > GAP:
            break
    return first


def _beyond_ink(found: ArmContours, fine: ArmRaster) -> Floats:
    """Return the offsets (r,) moved beyond the ink, at most by the usual width of a line."""
    offsets = found.offsets[0]
    steps = np.arange(TRACED[2] + 1)
    places = found.starts[0][:, None] + found.steps[0][:, None] * steps
    is_ink = fine.sample(fine.ink, places) >= SEEN
    stops = np.where((steps >= offsets[:, None]) & ~is_ink, steps, TRACED[2]).min(axis=1)
    starts = np.where((steps <= offsets[:, None]) & ~is_ink, steps, 0).max(axis=1)
    is_line = (stops > offsets) & ~found.is_edge[0]
    usual = THICK * float(np.median((stops - starts)[is_line])) if is_line.any() else 0.0
    # Beside a mere change of colour, the contour keeps to the arm's side of what is blurred.
    moved = np.where(is_line, np.minimum(stops, starts + usual) + BESIDE_INK, offsets)
    return np.asarray(moved, np.float64)


def _trace(raster: ArmRaster, axes: Complexes, rays: tuple[int, int, int]) -> ArmContours:
    _, around, radii = rays
    return trace_contours(raster, axes, around=around, radii=radii)


def with_near_arm(joints: Mapping[str, complex], arm: NearArm, facing: int) -> dict[str, complex]:
    """Return the joints with this arm on the near side.

    An arm that the silhouette showed is its part beyond the trunk, or else the far arm. Joints with
    two other arms stay.
    """
    near = near_side(facing)
    sides = {"L": "", "R": ""}
    for side in "LR":
        places = [joints[f"{name}.{side}"] for name in ARM if f"{name}.{side}" in joints]
        if places and not contains(arm.contour, np.array(places)).any():
            sides[side] = side
    if all(sides.values()):
        return dict(joints)
    far = "".join(sides.values())
    found = {name: at for name, at in joints.items() if name.rpartition(".")[0] not in ARM}
    for name, place in zip(ARM, arm.joints, strict=True):
        if f"{name}.{far}" in joints:
            found[f"{name}.{SIDES[near]}"] = joints[f"{name}.{far}"]
        found[f"{name}.{near}"] = place
    return found


def move_off_arm(
    joints: Mapping[str, complex], arm: NearArm, loops: Sequence[Complexes], near: str
) -> dict[str, complex]:
    """Return the joints of the trunk and the legs moved from below an arm to beside it.

    A hip moves towards its knee, so that the leg turns in its middle.
    """
    least = ROOM * box_diagonal(loops[0])
    flap = shapely.buffer(shapely.Polygon(as_xy(arm.contour)), least)
    free = shapely.difference(shapely.buffer(shapely_region(loops[0], loops[1:]), -least), flap)
    moved = dict(joints)
    for name, place in joints.items():
        kind, _, side = name.rpartition(".")
        if (kind in ARM and side == near) or not shapely.contains_xy(flap, place.real, place.imag):
            continue
        knee = joints.get(f"knee.{side}") if kind == "hip" else None
        ways = [shapely.LineString(as_xy(np.array([place, knee])))] if knee is not None else []
        for within in (*(shapely.intersection(free, way) for way in ways), free):
            if not shapely.is_empty(within):
                nearest = shapely.shortest_line(shapely.Point(place.real, place.imag), within)
                moved[name] = complex(*shapely.get_coordinates(nearest)[1])
                break
    return moved


def _score(found: ArmContours, tall: float) -> Floats:
    """Return how clear each contour is, and more for longer arms."""
    lengths = np.abs(np.diff(found.axes, axis=1)).sum(axis=1)
    return np.asarray(found.clearness() + LONGER * np.minimum(lengths / tall, LONGEST))


def _guess_axes(top: complex, hips: complex, facing: int) -> Complexes:
    """Return guessed axes (c, 3) by shoulder, elbow and hand."""
    tall = abs(hips - top)
    down = (hips - top) / tall
    ahead = down * 1j * facing
    shoulders = top + tall * (np.array(DOWN)[:, None] * down + np.array(ASIDE) * ahead).ravel()
    turns = down * np.exp(1j * facing * np.radians(TURNED))
    grid = np.meshgrid(shoulders, tall * np.array(LONG), turns, np.array(BENT), indexing="ij")
    shoulder, length, turn, bend = (each.ravel() for each in grid)
    along = length / np.hypot(1.0, 2 * bend) * turn
    elbow = shoulder + along * (0.5 - 1j * facing * bend)
    return np.stack([shoulder, elbow, shoulder + along], axis=1)
