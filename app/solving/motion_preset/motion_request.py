"""Requested motion preset of a layer, and the handles at its joints."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from app.document import Layer, MotionEdits
from app.errors import LissomError
from app.rigging import Body, Motion, Parameters, find_kind, find_motion, guess_facing
from app.solving.motion_preset.rigid_points import find_rigid_points
from app.texts import _
from engine.arrays import Complexes
from engine.geometry import diameter

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
    return Body(
        kind=kind,
        joints=joints,
        box=(complex(x.min(), y.min()), complex(x.max(), y.max())),
        facing=find_facing(layer, order),
    )


def _on_drawing(layer: Layer, joints: Mapping[str, complex]) -> dict[str, complex]:
    """Return joints on the layer; joints slightly outside move to the outline."""
    tolerance = BESIDE * diameter(layer.domain.outline)
    points: Complexes = np.array(list(joints.values()), dtype=np.complex128)
    covered = layer.covers(points, tolerance=tolerance)
    for (name, place), is_on_it in zip(joints.items(), covered, strict=True):
        if not is_on_it:
            raise LissomError(
                _(
                    "the joint {name!r} at ({x:g}, {y:g}) is not on the drawing; move it onto "
                    "the drawing"
                ).format(name=name, x=place.real, y=place.imag)
            )
    nearest = layer.domain.nearest(points).tolist()
    return dict(zip(joints, nearest, strict=True))
