"""Commands on pose keys: pose, insert, paste, and what only they have."""

from collections.abc import Collection
from dataclasses import replace

from app.document.channels.easing import LINEAR, Easing
from app.document.commands.command import layer_command
from app.document.commands.keys import (
    retime,
)
from app.document.keyframe import Keyframe, Pose
from app.document.layer import Layer
from app.errors import LissomError
from app.texts import _


@layer_command(_("Pose"))
def replace_key_pose(layer: Layer, frame: int, pose: Pose) -> Layer:
    return replace_keys(layer, {frame: replace(layer.key(frame), pose=pose)})


@layer_command(_("Insert key"))
def insert_key(layer: Layer, frame: int, pose: Pose, *, easing: Easing = LINEAR) -> Layer:
    """Insert a key at a frame without a key.

    A key within a segment takes the easing of the segment. New segments take `easing`: the segment
    from a new first key, or the segment from the former last key if its easing is linear. The
    document's frames grow to contain the key, as in all commands here.
    """
    return _inserted(layer, frame, pose, easing)


@layer_command(_("Paste pose"))
def insert_pose(layer: Layer, frame: int, pose: Pose, easing: Easing) -> Layer:
    """Set the pose of the key at a frame, or insert a key."""
    if frame not in layer.key_frames:
        return _inserted(layer, frame, pose, easing)
    old = layer.key(frame)
    return layer if old.pose is pose else replace_keys(layer, {frame: replace(old, pose=pose)})


@layer_command(_("Make last key equal first"))
def match_loop_ends(layer: Layer) -> Layer:
    first, last = layer.keys[0], layer.keys[-1]
    if first is last:
        raise LissomError(_("A loop needs two keys; insert a second one first."))
    if first.pose is last.pose:
        return layer
    return replace_keys(layer, {last.frame: replace(last, pose=first.pose)})


@layer_command(_("Set turns"))
def set_revolutions(layer: Layer, frames: Collection[int], turns: int) -> Layer:
    """Set the additional full turns after the keys at some frames."""
    keys = retime.keys_at_frames(layer.keys, frames)
    return replace_keys(
        layer,
        {key.frame: replace(key, revolutions=turns) for key in keys if key.revolutions != turns},
    )


def _inserted(layer: Layer, frame: int, pose: Pose, easing: Easing) -> Layer:
    new = Keyframe(frame=frame, pose=pose, easing=easing)
    return _with_keys(layer, retime.with_inserted_key(layer.keys, new))


def replace_keys(layer: Layer, changed: dict[int, Keyframe]) -> Layer:
    """Return the layer with other keys at some frames, the same object without a change."""
    return _with_keys(layer, retime.with_replaced_keys(layer.keys, changed))


def _with_keys(layer: Layer, keys: tuple[Keyframe, ...]) -> Layer:
    return layer if keys is layer.keys else replace(layer, keys=keys)
