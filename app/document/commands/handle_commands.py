"""Commands on handles. No command here changes a map, so the drawing stays the same."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from app.document.commands.command import layer_command, with_number
from app.document.commands.keys.track_handles import with_moved_handle, without_handles
from app.document.keyframe import Handle, Pose, Target
from app.document.layer import Layer
from app.texts import _


@layer_command(_("Add handle"))
def add_handle(
    layer: Layer, position: complex, *, name: str | None = None, weight: float = 1.0
) -> Layer:
    """Add a handle at a point of the picture; its target in each key is the point's image.

    The position is on the shape, in pixels of the picture at rest, y up. The default name is
    "handle 1" and so on. The new handle's id is `layer.next_handle`.
    """
    handle = Handle(
        id=layer.next_handle,
        name=next_handle_name(layer) if name is None else name,
        position=position,
        weight=weight,
    )
    _require_on_shape(layer, handle)
    return _with_poses(layer, partial(_follow, layer, handle), (*layer.handles, handle))


@layer_command(_("Add handles"))
def add_handles(layer: Layer, handles: Sequence[Handle]) -> Layer:
    """Add several handles; they get new ids from `layer.next_handle` on."""
    for number, handle in enumerate(handles, start=layer.next_handle):
        added = replace(handle, id=number)
        _require_on_shape(layer, added)
        layer = _with_poses(layer, partial(_follow, layer, added), (*layer.handles, added))
    return layer


@layer_command(_("Move handle"))
def move_handle(layer: Layer, identity: int, position: complex) -> Layer:
    """Move a handle on the picture; its targets become the images of its new position."""
    if layer.handle(identity).position == position:
        return layer
    handle = replace(layer.handle(identity), position=position)
    _require_on_shape(layer, handle)
    handles = tuple(handle if handle.id == other.id else other for other in layer.handles)
    moved = with_moved_handle(layer, identity, position)
    return _with_poses(moved, partial(_follow, layer, handle), handles)


@layer_command(_("Delete handle"))
def remove_handles(layer: Layer, identities: Collection[int]) -> Layer:
    """Delete handles with their springs, tracks and bones. The poses keep their shapes."""
    gone = {layer.handle(identity).id for identity in identities}
    if not gone:
        return layer

    def remaining(pose: Pose) -> Pose:
        targets = {i: target for i, target in pose.targets.items() if i not in gone}
        return replace(pose, targets=targets)

    handles = tuple(handle for handle in layer.handles if handle.id not in gone)
    channels = {name: keys for name, keys in layer.channels.items() if name[1] not in gone}
    motions = tuple(
        replace(each, joints={name: i for name, i in each.joints.items() if i not in gone})
        for each in layer.motions
    )
    left = without_handles(replace(layer, channels=channels, motions=motions), gone)
    return _with_poses(left, remaining, handles)


@layer_command(_("Rename handle"))
def rename_handle(layer: Layer, identity: int, name: str) -> Layer:
    return with_handles(layer, {identity}, name=name)


@layer_command(_("Set handle weight"))
def set_handle_weight(layer: Layer, identities: Collection[int], weight: float) -> Layer:
    """Set the weight of handles in later solves."""
    return with_handles(layer, identities, weight=weight)


@layer_command(_("Lock or unlock handles"))
def lock_handles(layer: Layer, identities: Collection[int], *, locked: bool) -> Layer:
    return with_handles(layer, identities, locked=locked)


@layer_command(_("Toggle auto-pin"))
def unpin_handles(layer: Layer, identities: Collection[int], *, free: bool) -> Layer:
    """Turn auto-pin off or on for handles."""
    return with_handles(layer, identities, is_unpinned=free)


@layer_command(_("Group handles"))
def group_handles(layer: Layer, identities: Collection[int], group: str) -> Layer:
    """Put handles in a group that is selected and dragged together; "" ungroups them."""
    return with_handles(layer, identities, group=group.strip())


def with_handles(layer: Layer, identities: Collection[int], **changes: Any) -> Layer:
    """Return the layer with changed handle fields, the same object without a change."""
    for identity in identities:
        layer.handle(identity)
    handles = tuple(
        replace(handle, **changes) if handle.id in identities else handle
        for handle in layer.handles
    )
    return layer if handles == layer.handles else replace(layer, handles=handles)


def _with_poses(layer: Layer, change: Callable[[Pose], Pose], handles: tuple[Handle, ...]) -> Layer:
    """Return the layer with other handles and with every pose changed."""
    return layer.with_poses(
        map(change, layer.poses),
        handles=handles,
        next_handle=max([layer.next_handle, *(handle.id + 1 for handle in handles)]),
    )


def _require_on_shape(layer: Layer, handle: Handle) -> None:
    """Refuse a handle outside the shape, where the map is not defined."""
    layer.require_on_shape({_("The handle {name!r}").format(name=handle.name): handle.position})


def _follow(layer: Layer, handle: Handle, pose: Pose) -> Pose:
    """Return a pose whose target for the handle is the handle's image under the map."""
    old = pose.targets.get(handle.id)
    (place,) = layer.map_of(pose)(np.array([handle.position], dtype=np.complex128))
    position = complex(place)
    target = Target(position=position) if old is None else replace(old, position=position)
    return replace(pose, targets={**pose.targets, handle.id: target})


def next_handle_name(layer: Layer) -> str:
    taken = {handle.name for handle in layer.handles}
    return with_number("handle", taken, layer.next_handle + 1)
