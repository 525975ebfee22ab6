"""Commands on what has keys of its own: the camera, and how figures fade, move and are ordered."""

from collections.abc import Collection
from dataclasses import replace
from typing import TypeVar

from app.document.commands import keys_in_time
from app.document.commands.command import command, figure_command
from app.document.commands.keys_in_time import Row
from app.document.figure import Figure
from app.document.layering import CameraKey, MoveKey, OpacityKey, Placing
from app.document.model import Document
from app.document.queries import keyed_frame, repeating
from app.document.settings import FrameRange

Key = TypeVar("Key", CameraKey, MoveKey, OpacityKey)
Moving = TypeVar("Moving", MoveKey, OpacityKey)


@command("Key the camera")
def key_camera(document: Document, key: CameraKey) -> Document:
    """Let the camera have a key, in place of the one at its frame, whose way on it keeps."""
    return _filmed(document, _with(document.camera, key, [key.frame]))


@command("Move camera key")
def move_camera_key(document: Document, frame: int, to: int) -> Document:
    """Move the key of the camera at a frame to another one."""
    return _filmed(document, keys_in_time.moved(document.camera, {frame}, to - frame))


@command("Delete camera key")
def delete_camera_key(document: Document, frame: int) -> Document:
    """Delete the key of the camera at a frame; without any, frames show the canvas."""
    return _filmed(document, keys_in_time.without(document.camera, {frame}))


@figure_command("Key opacity")
def key_opacity(figure: Figure, frame: int, opacity: float) -> Figure:
    """Let a figure be so opaque at a frame, and fade evenly from key to key."""
    row = figure.opacities
    new = OpacityKey(frame=keyed_frame(figure, row, frame), opacity=float(opacity))
    changed = _with(row, new, _like(figure, row, new.frame))
    return figure if changed is row else replace(figure, opacities=changed)


@figure_command("Delete opacity key")
def delete_opacity_key(figure: Figure, frame: int) -> Figure:
    """Delete a key of a figure's opacity; without any it stays as opaque as the last one had it."""
    row = figure.opacities
    left = keys_in_time.without(row, {keyed_frame(figure, row, frame)})
    if left:
        return replace(figure, opacities=left)
    return replace(figure, opacities=(), opacity=row[0].opacity)


@figure_command("Key movement")
def key_movement(figure: Figure, frame: int, shift: complex, turn: float) -> Figure:
    """Let a whole figure be moved and turned so at a frame, beside where its poses have it."""
    row = figure.movement
    new = MoveKey(frame=keyed_frame(figure, row, frame), shift=shift, turn=float(turn))
    changed = _with(row, new, _like(figure, row, new.frame))
    return figure if changed is row else replace(figure, movement=changed)


@figure_command("Delete movement key")
def delete_movement_key(figure: Figure, frame: int) -> Figure:
    """Delete a key of a figure's movement; without any it is where its poses have it."""
    row = figure.movement
    left = keys_in_time.without(row, {keyed_frame(figure, row, frame)})
    return replace(figure, movement=left)


@figure_command("Set order from here on")
def place_at(figure: Figure, placing: Placing) -> Figure:
    """Paint a figure right in front of another one, or behind it, from a frame on."""
    others = [each for each in figure.placings if each.frame != placing.frame]
    placings = tuple(sorted([*others, placing], key=lambda each: each.frame))
    return figure if placings == figure.placings else replace(figure, placings=placings)


@figure_command("Change no order here")
def unplace_at(figure: Figure, frame: int) -> Figure:
    """Take back what is said of a figure's order from a frame on."""
    placings = tuple(each for each in figure.placings if each.frame != frame)
    return figure if placings == figure.placings else replace(figure, placings=placings)


def _like(figure: Figure, row: Row[Moving], frame: int) -> list[int]:
    """Return a frame, and that of the key which is the one there again: where a cycle ends."""
    cycle = repeating(figure, row)
    if cycle is not None and (frame, frame + cycle.period) == (row[0].frame, row[-1].frame):
        return [frame, row[-1].frame]
    return [frame]


def _with(row: Row[Key], key: Key, frames: Collection[int]) -> Row[Key]:
    """Return a row with a key, or with ones like it for those at some frames.

    Their ways on are kept, and by how many whole turns the later ones have turned around.
    """
    olds = [each for each in row if each.frame in frames]
    if not olds:
        return keys_in_time.inserted(row, key) if row else (key,)
    put: dict[int, Key] = {}
    for old in olds:
        new = replace(
            key, frame=old.frame, easing=old.easing, passing=old.passing, unknown=old.unknown
        )
        if isinstance(new, MoveKey) and isinstance(old, MoveKey) and isinstance(olds[0], MoveKey):
            new = replace(new, turn=new.turn + old.turn - olds[0].turn)
        put[old.frame] = new
    return keys_in_time.exchanged(row, put)


def _filmed(document: Document, camera: tuple[CameraKey, ...]) -> Document:
    """Return a document with another camera, and with room for its keys."""
    if camera is document.camera:
        return document
    ends = [document.frames.first, document.frames.last, *(key.frame for key in camera)]
    return replace(document, camera=camera, frames=FrameRange(min(ends), max(ends)))
