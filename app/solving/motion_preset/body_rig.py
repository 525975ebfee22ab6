"""The rig of a body: a handle at each joint, bones along the limbs, and near limbs in front."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise

import numpy as np

from app.document import Document, handle_commands, stiffness_commands, with_number
from app.rigging import Body, near_side
from engine.errors import EngineError
from engine.geometry import diameter

SAME_JOINT = 0.004  # of the drawing's diameter: a handle this close to a joint is its handle
HEAD = 1.1  # radius of a stiff head, in distances of its middle from the outline
UPPER = 0.5  # of the way from the crown down to the next joint: a head's middle is in this part
STIFF_HEAD = 20.0
DEPTH = 0.6  # of near limbs, and below 0 of far limbs
# Of the bone before a joint: the depth of a joint reaches this far.
EXTENT = 1.3


def rig_body(
    document: Document, identity: int, body: Body, handles: Mapping[str, int]
) -> tuple[Document, dict[str, int]]:
    """Return a document with the rig of a body, and the handles by joint.

    `handles` are known handles by joint, which move to the joints. What exists stays: other
    handles, bones, and depths of handles.
    """
    joints, before = dict[str, int](), document.layer(identity)
    for name, place in body.joints.items():
        document, joints[name] = _with_handle(document, identity, name, place, handles, joints)
    if not body.kind.parents:
        # Rigid motions move all handles, so auto-pin is off.
        unpin = handle_commands.unpin_handles(identity, set(joints.values()), free=True)
        return unpin(document), joints
    for root, end in find_bones(body):
        ends = joints[root], joints[end]
        if any(bone.is_between(ends) for bone in document.layer(identity).bones):
            continue
        # If a bone would leave the drawing, the limb stays without bone.
        with suppress(EngineError):
            document = stiffness_commands.add_bone(identity, ends)(document)
    if "head" in joints and before.stiffness is None:
        document = _with_stiff_head(document, identity, body)
    if body.kind.is_side_view:
        new = set(joints.values()) - {handle.id for handle in before.handles}
        document = _with_depths(
            document,
            identity,
            body,
            {name: handle for name, handle in joints.items() if handle in new},
        )
    return document, joints


def find_bones(body: Body) -> Iterator[tuple[str, str]]:
    """Yield the bones of a body's limbs, tail and head, and of a chain, each from root to end."""
    for end in ("foot.L", "foot.R", "hand.L", "hand.R"):
        if end in body.joints:
            yield from pairwise(body.limb_joints(end))
    yield from pairwise(body.tail)
    if "neck" in body.joints and "head" in body.joints:
        yield "neck", "head"
    if body.kind.name == "chain":
        yield from pairwise(body.joints)


def _with_handle(
    document: Document,
    identity: int,
    name: str,
    place: complex,
    handles: Mapping[str, int],
    others: Mapping[str, int],
) -> tuple[Document, int]:
    """Return a document with a handle at a joint, and the handle's id."""
    layer = document.layer(identity)
    known = handles.get(name)
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


def _with_stiff_head(document: Document, identity: int, body: Body) -> Document:
    """Return a document whose heads are stiff: the largest disc between the neck and the crown."""
    outline, crown = document.layer(identity).domain.outline, body.joints["head"]
    below = body.joints.get(body.parents["head"], crown)
    between = crown + UPPER * np.linspace(0.0, 1.0, 40) * (below - crown)
    rooms = np.abs(outline - between[:, None]).min(axis=1)
    widest = int(rooms.argmax())
    return stiffness_commands.paint_stiffness(
        identity, [complex(between[widest])], radius=HEAD * float(rooms[widest]), amount=STIFF_HEAD
    )(document)


def _with_depths(
    document: Document, identity: int, body: Body, joints: Mapping[str, int]
) -> Document:
    """Return a document with the near limbs of a side view in front, and the far ones behind."""
    near, depths = near_side(body.facing), dict[int, tuple[float, float]]()
    for name, handle in joints.items():
        kind, _, side = name.rpartition(".")
        if side and kind in {"knee", "foot", "elbow", "hand"}:
            before = body.parents[name]
            extent = EXTENT * abs(body.joints[name] - body.joints[before])
            depths[handle] = (DEPTH if side == near else -DEPTH, extent)
    layer = document.layer(identity)
    changed = tuple(
        replace(each, depth=depths[each.id][0], extent=depths[each.id][1])
        if each.id in depths
        else each
        for each in layer.handles
    )
    return document.with_layer(replace(layer, handles=changed))
