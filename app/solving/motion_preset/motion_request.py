"""Requested motion preset of a layer, and the handles at its joints."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import shapely

from app.document import Layer, MotionEdits
from app.errors import LissomError
from app.rigging import (
    Body,
    Motion,
    Parameters,
    find_kind,
    find_motion,
    guess_facing,
    other_side,
)
from app.solving.motion_preset.rigid_points import find_rigid_points
from app.texts import _
from engine.arrays import Complexes
from engine.geometry import arc_lengths, as_xy, diameter, shapely_region

SHARES = np.linspace(0.0, 1.0, 41)  # of a limb from its root
NEAR_ROOT = 2.0  # power by which room grows as the crotch is nearer to the roots
BESIDE = 0.01  # of the drawing's diameter: a joint this far outside moves to the outline


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionRequest:
    """A request to apply a motion preset to a layer.

    Raises an `EngineError` if the motion or the kind does not exist, or the motion is not made for
    the kind.
    """

    motion: str
    kind: str
    joints: Mapping[str, complex]  # at rest, in pixels of the canvas, y up
    parameters: Parameters = field(default_factory=Parameters)
    first: int = 0  # first frame
    repeat_count: int = 1  # number of repeats
    facing: int | None = None  # 1 looks to the right, -1 to the left; None lets the program guess
    # Existing handles by joint name; they move to the joints.
    handles: Mapping[str, int] = field(default_factory=dict)
    edits: MotionEdits | None = None  # changes by hand of the motion that it replaces
    # Start of that motion, and frames of its cycle.
    edited_start: int = 0
    edited_period: int = 1

    def __post_init__(self) -> None:
        self.preset.template_for(self.kind)

    @property
    def preset(self) -> Motion:
        find_kind(self.kind)
        return find_motion(self.motion)


def find_facing(layer: Layer, order: MotionRequest) -> int:
    """Return the direction in which the layer looks: 1 to the right, -1 to the left."""
    if order.facing is not None:
        return order.facing
    return guess_facing(find_kind(order.kind), order.joints, layer.domain.outline)


def find_rest_body(layer: Layer, order: MotionRequest) -> Body:
    """Return the body of an undeformed layer.

    Raises a `LissomError` or `EngineError` if a joint is not on the drawing, or the kind has no
    such joint.
    """
    outline, kind = layer.domain.outline, find_kind(order.kind)
    x, y = outline.real, outline.imag
    joints = dict(order.joints) if kind.parents else find_rigid_points(layer.domain)
    if kind.parents:
        kind.require_joints(joints)
        joints = _on_drawing(layer, joints)
    body = Body(
        kind=kind,
        joints=joints,
        box=(complex(x.min(), y.min()), complex(x.max(), y.max())),
        facing=find_facing(layer, order),
    )
    return replace(body, crotch_room=_find_crotch_rooms(layer, body))


def _find_crotch_rooms(layer: Layer, body: Body) -> dict[str, float]:
    """Return the room at the crotch of each pair of legs that are one above it."""
    rooms, region = dict[str, float](), shapely_region(layer.domain.outline, layer.domain.loops[1:])
    for foot in ("foot.L", "hand.L"):
        pair = foot, other_side(foot)
        if not all(name in body.joints for name in pair):
            continue
        one, other = (_along_limb(body, name) for name in pair)
        ways = shapely.linestrings(np.stack([as_xy(one), as_xy(other)], axis=1))
        is_one = shapely.covers(region, ways)
        crotch = int((~is_one).argmax()) if not is_one.all() else len(SHARES) - 1
        if crotch > 0:
            room = float(abs(other[crotch] - one[crotch]) / SHARES[crotch] ** NEAR_ROOT)
            rooms |= dict.fromkeys(pair, room)
    return rooms


def _along_limb(body: Body, end: str) -> Complexes:
    places = np.array([body.joints[name] for name in body.limb_joints(end)])
    lengths = arc_lengths(places)
    return np.asarray(np.interp(SHARES * lengths[-1], lengths, places))


def _on_drawing(layer: Layer, joints: Mapping[str, complex]) -> dict[str, complex]:
    """Return joints on the layer; joints slightly outside move to the outline."""
    tolerance = BESIDE * diameter(layer.domain.outline)
    points: Complexes = np.array(list(joints.values()), dtype=np.complex128)
    covered = layer.covers(points, tolerance=tolerance)
    for (name, place), is_on_it in zip(joints.items(), covered, strict=True):
        if not is_on_it:
            raise LissomError(
                _(
                    "the joint {name!r} at ({x:.0f}, {y:.0f}) is not on the drawing; move it onto "
                    "the drawing"
                ).format(name=name, x=place.real, y=place.imag)
            )
    nearest = layer.domain.nearest(points).tolist()
    return dict(zip(joints, nearest, strict=True))
