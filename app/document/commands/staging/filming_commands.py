"""Commands on what has keys of its own: the camera, and how figures fade, move and are ordered."""

from dataclasses import replace
from typing import TypeVar

from app.document.commands import keys_in_time
from app.document.commands.command import command, figure_command
from app.document.figure import Figure
from app.document.layering import CameraKey, MoveKey, OpacityKey, Placing
from app.document.model import Document
from app.document.queries import keyed_frame, repeating
from app.document.settings import FrameRange

Moving = TypeVar("Moving", MoveKey, OpacityKey)


@command("Key the camera")
def key_camera(document: Document, key: CameraKey) -> Document:
    """Let the camera have a key, in place of the one at its frame, whose way on it keeps."""
    row = document.camera
    old = next((each for each in row if each.frame == key.frame), None)
    if old is not None:
        put = replace(key, easing=old.easing, passing=old.passing, unknown=old.unknown)
        return _filmed(document, keys_in_time.exchanged(row, {key.frame: put}))
    return _filmed(document, keys_in_time.inserted(row, key) if row else (key,))


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
    olds = _at(figure, row, new.frame)
    if olds:
        put = {old.frame: replace(old, opacity=new.opacity) for old in olds}
        changed = keys_in_time.exchanged(row, put)
        return figure if changed is row else replace(figure, opacities=changed)
    return replace(figure, opacities=keys_in_time.inserted(row, new) if row else (new,))


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
    olds = _at(figure, row, new.frame)
    if olds:
        # One at the end of what repeats may have turned around some times more.
        put = {
            old.frame: replace(old, shift=shift, turn=new.turn + old.turn - olds[0].turn)
            for old in olds
        }
        changed = keys_in_time.exchanged(row, put)
        return figure if changed is row else replace(figure, movement=changed)
    return replace(figure, movement=keys_in_time.inserted(row, new) if row else (new,))


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


def _at(figure: Figure, row: keys_in_time.Row[Moving], frame: int) -> list[Moving]:
    """Return the key of a movement or an opacity at a frame, and that which is to be like it.

    Where a row fills a cycle, its last key is its first one again.
    """
    found = [each for each in row if each.frame == frame]
    cycle = repeating(figure, row)
    if cycle is not None and found[:1] == [row[0]] and row[-1].frame - frame == cycle.period:
        found.append(row[-1])
    return found


def _filmed(document: Document, camera: tuple[CameraKey, ...]) -> Document:
    """Return a document with another camera, and with room for its keys."""
    if camera is document.camera:
        return document
    ends = [document.frames.first, document.frames.last, *(key.frame for key in camera)]
    return replace(document, camera=camera, frames=FrameRange(min(ends), max(ends)))
