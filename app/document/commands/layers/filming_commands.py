"""Commands on keys of the camera, and of a layer's opacity, transform and draw order."""

from collections.abc import Collection
from dataclasses import replace
from typing import TypeVar

from app.document.commands import retime
from app.document.commands.command import command, layer_command
from app.document.commands.retime import Keys
from app.document.layer import Layer
from app.document.layers.layer_keys import CameraKey, DrawOrderKey, OpacityKey, TransformKey
from app.document.model import Document
from app.document.queries.layers.layer_state import keyed_frame, repeating_cycle
from app.document.queries.layers.visibility import change_frame
from app.document.settings import FrameRange
from app.texts import _

Key = TypeVar("Key", CameraKey, TransformKey, OpacityKey)
Moving = TypeVar("Moving", TransformKey, OpacityKey)


@command(_("Key the camera"))
def key_camera(document: Document, key: CameraKey) -> Document:
    """Set the camera key at a frame; an existing key keeps its easing and tangent mode."""
    return _with_camera(document, _with(document.camera, key, [key.frame]))


@command(_("Move camera key"))
def move_camera_key(document: Document, frame: int, to: int) -> Document:
    return _with_camera(document, retime.with_moved_keys(document.camera, {frame}, to - frame))


@command(_("Delete camera key"))
def delete_camera_key(document: Document, frame: int) -> Document:
    """Delete the camera key at a frame; without keys, frames show the canvas."""
    return _with_camera(document, retime.without_keys(document.camera, {frame}))


@layer_command(_("Key opacity"))
def key_opacity(layer: Layer, frame: int, opacity: float) -> Layer:
    row = layer.opacity_keys
    new = OpacityKey(frame=keyed_frame(layer, row, frame), opacity=float(opacity))
    changed = _with(row, new, _like(layer, row, new.frame))
    return layer if changed is row else replace(layer, opacity_keys=changed)


@layer_command(_("Delete opacity key"))
def delete_opacity_key(layer: Layer, frame: int) -> Layer:
    """Delete an opacity key; the layer keeps the opacity of the last deleted key."""
    row = layer.opacity_keys
    left = retime.without_keys(row, {keyed_frame(layer, row, frame)})
    if left:
        return replace(layer, opacity_keys=left)
    return replace(layer, opacity_keys=(), opacity=row[0].opacity)


@layer_command(_("Key transform"))
def key_movement(layer: Layer, frame: int, shift: complex, turn: float) -> Layer:
    row = layer.transform_keys
    new = TransformKey(frame=keyed_frame(layer, row, frame), shift=shift, turn=float(turn))
    changed = _with(row, new, _like(layer, row, new.frame))
    return layer if changed is row else replace(layer, transform_keys=changed)


@layer_command(_("Delete transform key"))
def delete_movement_key(layer: Layer, frame: int) -> Layer:
    row = layer.transform_keys
    left = retime.without_keys(row, {keyed_frame(layer, row, frame)})
    return replace(layer, transform_keys=left)


@layer_command(_("Set order key"))
def place_at(layer: Layer, key: DrawOrderKey) -> Layer:
    """Draw a layer directly in front of or behind another one from a frame on."""
    at = change_frame(layer.draw_order_keys, layer.cycles, key.frame)
    key = replace(key, frame=at)
    others = [each for each in layer.draw_order_keys if each.frame != key.frame]
    order_keys = tuple(sorted([*others, key], key=lambda each: each.frame))
    return (
        layer if order_keys == layer.draw_order_keys else replace(layer, draw_order_keys=order_keys)
    )


@layer_command(_("Delete order key"))
def unplace_at(layer: Layer, frame: int) -> Layer:
    """Delete the draw order key at a frame."""
    at = change_frame(layer.draw_order_keys, layer.cycles, frame)
    order_keys = tuple(each for each in layer.draw_order_keys if each.frame != at)
    return (
        layer if order_keys == layer.draw_order_keys else replace(layer, draw_order_keys=order_keys)
    )


def _like(layer: Layer, row: Keys[Moving], frame: int) -> list[int]:
    """Return the frame and, if it starts a cycle, the frame of the equal key at the cycle's end."""
    cycle = repeating_cycle(layer, row)
    if cycle is not None and (frame, frame + cycle.period) == (row[0].frame, row[-1].frame):
        return [frame, row[-1].frame]
    return [frame]


def _with(row: Keys[Key], key: Key, frames: Collection[int]) -> Keys[Key]:
    """Return the keys with one key at its frame, or with equal keys at several frames.

    Existing keys keep easing, tangent mode and, relative to the first, their rotation.
    """
    olds = [each for each in row if each.frame in frames]
    if not olds:
        return retime.with_inserted_key(row, key) if row else (key,)
    put: dict[int, Key] = {}
    for old in olds:
        new = replace(
            key,
            frame=old.frame,
            easing=old.easing,
            tangent_mode=old.tangent_mode,
            unknown=old.unknown,
        )
        if (
            isinstance(new, TransformKey)
            and isinstance(old, TransformKey)
            and isinstance(olds[0], TransformKey)
        ):
            new = replace(new, turn=new.turn + old.turn - olds[0].turn)
        put[old.frame] = new
    return retime.with_replaced_keys(row, put)


def _with_camera(document: Document, camera: tuple[CameraKey, ...]) -> Document:
    """Return a document with other camera keys; its frames grow to contain the keys."""
    if camera is document.camera:
        return document
    ends = [document.frames.first, document.frames.last, *(key.frame for key in camera)]
    return replace(document, camera=camera, frames=FrameRange(min(ends), max(ends)))
