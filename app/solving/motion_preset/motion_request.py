"""Requested motion preset of a layer, and the handles at its joints."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np

from app.document import (
    RUBBERY,
    Document,
    Layer,
    handle_commands,
    shape_commands,
    stiffness_commands,
    with_number,
)
from app.errors import LissomError
from app.rigging import Body, Motion, Parameters, find_kind, find_motion, guess_facing
from app.solving.motion_preset.rigid_points import find_rigid_points
from app.texts import _
from engine.arrays import Complexes
from engine.errors import EngineError
from engine.geometry import diameter
from engine.maps import Bounds

# Fractions of the drawing's diameter: a handle this close to a joint is its handle; a joint this
# far outside moves to the outline.
SAME_JOINT, BESIDE = 0.004, 0.01
TRUNK = ("neck", "head", "chest")
STIFF_TRUNK, STIFF_LIMB, STIFF_HEAD = 10.0, 3.0, 20.0
HEAD = 1.5  # radius as a multiple of the distance from the head's joint to the outline


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
    stiff: bool = True  # whether the trunk becomes stiff, so that mainly limbs move
    bones: bool = False  # whether limbs get bones
    # The layer's limits become at least these; None leaves them unchanged.
    limits: Bounds | None = RUBBERY.bounds

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


def with_handles_at_joints(
    document: Document, identity: int, body: Body, order: MotionRequest
) -> tuple[Document, dict[str, int]]:
    """Return a document with a handle at each joint and with bones, and the handles by joint."""
    joints = dict[str, int]()
    for name, place in body.joints.items():
        document, joints[name] = _with_handle(document, identity, name, place, order, joints)
    if not body.kind.parents:
        # Rigid motions move all handles, so auto-pin is off.
        document = handle_commands.unpin_handles(identity, set(joints.values()), free=True)(
            document
        )
    for name, before in body.parents.items():
        amount = STIFF_TRUNK if name in TRUNK else STIFF_LIMB
        if not before or not (order.stiff if name in TRUNK else order.bones):
            continue
        ends = joints[before], joints[name]
        if any(bone.is_between(ends) for bone in document.layer(identity).bones):
            continue
        # If a bone would leave the drawing, the limb stays without bone.
        with suppress(EngineError):
            document = stiffness_commands.add_bone(identity, ends, amount)(document)
    if order.stiff and "head" in joints:
        document = _with_stiff_head(document, identity, body.joints["head"])
    return document, joints


def _with_handle(
    document: Document,
    identity: int,
    name: str,
    place: complex,
    order: MotionRequest,
    others: Mapping[str, int],
) -> tuple[Document, int]:
    """Return a document with a handle at a joint, and the handle's id."""
    layer = document.layer(identity)
    known = order.handles.get(name)
    if known is not None and any(each.id == known for each in layer.handles):
        return handle_commands.move_handle(identity, known, place)(document), known
    near = SAME_JOINT * diameter(layer.domain.outline)
    free = [each for each in layer.handles if each.id not in others.values()]
    beside = min(free, key=lambda each: abs(each.position - place), default=None)
    if beside is not None and abs(beside.position - place) <= near:
        return document, beside.id
    taken = {handle.name for handle in layer.handles}
    new = name if name not in taken else with_number(name, taken, 2)
    added = handle_commands.add_handle(identity, place, name=new)(document)
    return added, layer.next_handle


def _with_stiff_head(document: Document, identity: int, head: complex) -> Document:
    outline = document.layer(identity).domain.outline
    radius = HEAD * float(np.abs(outline - head).min())
    return stiffness_commands.paint_stiffness(identity, [head], radius=radius, amount=STIFF_HEAD)(
        document
    )


def with_limits(document: Document, identity: int, limits: Bounds | None) -> Document:
    """Return a document whose layer has at least these limits."""
    own = document.layer(identity).bounds
    if limits is None:
        return document
    return shape_commands.set_limits(identity, own.joined(limits))(document)
