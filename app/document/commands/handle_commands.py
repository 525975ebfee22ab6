"""Commands on handles. None of them changes a map: whatever is shown stays as it is."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from app.document.commands.command import layer_command, with_number
from app.document.commands.track_handles import with_moved_handle, without_handles
from app.document.keyframe import Handle, Pose, Target
from app.document.layer import Layer


@layer_command("Add handle")
def add_handle(
    layer: Layer, position: complex, *, name: str | None = None, weight: float = 1.0
) -> Layer:
    """Add a handle at a point of the picture; each key's target is where its map takes the point.

    Parameters
    ----------
    position : complex
        In pixels of the picture at rest, y up, on the shape.
    name : str, optional
        "handle 1" and so on by default. The new handle's id is `layer.next_handle`.
    weight : float
        How strongly it pulls, relative to others.
    """
    handle = Handle(
        id=layer.next_handle,
        name=next_handle_name(layer) if name is None else name,
        position=position,
        weight=weight,
    )
    _require_on_shape(layer, handle)
    return _with_poses(layer, partial(_follow, layer, handle), (*layer.handles, handle))


@layer_command("Add handles")
def add_handles(layer: Layer, handles: Sequence[Handle]) -> Layer:
    """Add several handles at once; their ids are given anew, from `layer.next_handle` on."""
    for number, handle in enumerate(handles, start=layer.next_handle):
        added = replace(handle, id=number)
        _require_on_shape(layer, added)
        layer = _with_poses(layer, partial(_follow, layer, added), (*layer.handles, added))
    return layer


@layer_command("Move handle")
def move_handle(layer: Layer, identity: int, position: complex) -> Layer:
    """Put a handle elsewhere on the picture; its targets become where that point is now."""
    if layer.handle(identity).position == position:
        return layer
    handle = replace(layer.handle(identity), position=position)
    _require_on_shape(layer, handle)
    handles = tuple(handle if handle.id == other.id else other for other in layer.handles)
    moved = with_moved_handle(layer, identity, position)
    return _with_poses(moved, partial(_follow, layer, handle), handles)


@layer_command("Delete handle")
def remove_handles(layer: Layer, identities: Collection[int]) -> Layer:
    """Remove handles by their ids, with their springs, tracks and bones. The poses stay."""
    gone = {layer.handle(identity).id for identity in identities}
    if not gone:
        return layer

    def remaining(pose: Pose) -> Pose:
        targets = {i: target for i, target in pose.targets.items() if i not in gone}
        return replace(pose, targets=targets)

    handles = tuple(handle for handle in layer.handles if handle.id not in gone)
    keys = tuple(
        replace(key, depths={i: front for i, front in key.depths.items() if i not in gone})
        for key in layer.keys
    )
    motions = tuple(
        replace(each, joints={name: i for name, i in each.joints.items() if i not in gone})
        for each in layer.motions
    )
    left = without_handles(replace(layer, keys=keys, motions=motions), gone)
    return _with_poses(left, remaining, handles)


@layer_command("Rename handle")
def rename_handle(layer: Layer, identity: int, name: str) -> Layer:
    """Give a handle another name."""
    return with_handles(layer, {identity}, name=name)


@layer_command("Set handle weight")
def set_handle_weight(layer: Layer, identities: Collection[int], weight: float) -> Layer:
    """Let handles pull more or less strongly in poses that are solved from now on."""
    return with_handles(layer, identities, weight=weight)


@layer_command("Lock or unlock handles")
def lock_handles(layer: Layer, identities: Collection[int], *, locked: bool) -> Layer:
    """Lock handles in their places, or unlock them."""
    return with_handles(layer, identities, locked=locked)


@layer_command("Free or keep still")
def unpin_handles(layer: Layer, identities: Collection[int], *, free: bool) -> Layer:
    """Let handles move as they like between keys that have them at one place, or keep them."""
    return with_handles(layer, identities, free=free)


@layer_command("Group handles")
def group_handles(layer: Layer, identities: Collection[int], group: str) -> Layer:
    """Group handles under a name, to be selected and dragged together; with "", ungroup them."""
    return with_handles(layer, identities, group=group.strip())


def with_handles(layer: Layer, identities: Collection[int], **changes: Any) -> Layer:
    """Return the layer with some fields of some handles changed, itself if they have them."""
    for identity in identities:
        layer.handle(identity)
    handles = tuple(
        replace(handle, **changes) if handle.id in identities else handle
        for handle in layer.handles
    )
    return layer if handles == layer.handles else replace(layer, handles=handles)


def _with_poses(layer: Layer, change: Callable[[Pose], Pose], handles: tuple[Handle, ...]) -> Layer:
    """Return the layer with other handles, and every pose of it changed."""
    return layer.with_poses(
        map(change, layer.poses),
        handles=handles,
        next_handle=max([layer.next_handle, *(handle.id + 1 for handle in handles)]),
    )


def _require_on_shape(layer: Layer, handle: Handle) -> None:
    """Refuse a handle that poses cannot take anywhere."""
    layer.require_on_shape({f"handle {handle.name!r}": handle.position})


def _follow(layer: Layer, handle: Handle, pose: Pose) -> Pose:
    """Return a pose with the handle's target where its map takes the handle."""
    old = pose.targets.get(handle.id)
    (place,) = layer.map_of(pose)(np.array([handle.position], dtype=np.complex128))
    position = complex(place)
    target = Target(position=position) if old is None else replace(old, position=position)
    return replace(pose, targets={**pose.targets, handle.id: target})


def next_handle_name(layer: Layer) -> str:
    """Return a name that no handle has, for the next handle."""
    taken = {handle.name for handle in layer.handles}
    return with_number("handle", taken, layer.next_handle + 1)
