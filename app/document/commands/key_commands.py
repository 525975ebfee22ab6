"""Commands on pose keys: pose, insert, delete, and move in time."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from itertools import compress, pairwise
from typing import TypeVar

from app.document.commands import retime
from app.document.commands.command import layer_command
from app.document.commands.retime import TimeScale
from app.document.keyframe import Keyframe, Pose
from app.document.layer import Layer
from app.document.layers.layer_keys import DrawOrderKey
from app.document.layers.visibility import VisibilityKey
from app.document.queries.applied_motion import digest_keys, is_motion_unedited
from app.document.rig.applied_motion import AppliedMotion
from app.document.timing.cycles import Cycle
from app.document.timing.easing import LINEAR, Easing
from app.document.timing.tangent_mode import TangentMode
from app.errors import LissomError
from app.texts import _

Held = TypeVar("Held", VisibilityKey, DrawOrderKey)


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


@layer_command(_("Paste keys"))
def insert_keys(layer: Layer, keys: Sequence[Keyframe]) -> Layer:
    """Put keys at their frames, in place of existing keys."""
    return _with_keys(layer, retime.with_overwritten_keys(layer.keys, keys))


@layer_command(_("Move keys"))
def move_keys(layer: Layer, frames: Collection[int], by: int) -> Layer:
    """Move the keys at some frames, with their cycles and motion presets."""
    keys = retime.with_moved_keys(layer.keys, frames, by)
    return _rearranged(layer, keys, frames, lambda frame: frame + by)


@layer_command(_("Copy keys"))
def copy_keys(layer: Layer, frames: Collection[int], by: int) -> Layer:
    return _with_keys(layer, retime.with_copied_keys(layer.keys, frames, by))


@layer_command(_("Delete keys"))
def delete_keys(layer: Layer, frames: Collection[int]) -> Layer:
    """Delete the keys at some frames; one key must remain. Cycles without keys are deleted."""
    keys = retime.without_keys(layer.keys, frames)
    if not keys:
        raise LissomError(
            _("An animation needs at least one key. Change the pose of the last key instead.")
        )
    kept = {key.frame for key in keys}
    gone = {cycle for cycle in layer.cycles if not any(map(cycle.contains, kept))}
    gone &= {cycle for cycle in layer.cycles if any(map(cycle.contains, frames))}
    return _with_keys(layer, keys, tuple(each for each in layer.cycles if each not in gone))


@layer_command(_("Reverse keys"))
def reverse_keys(
    layer: Layer, frames: Collection[int], span: tuple[int, int] | None = None
) -> Layer:
    """Reverse the keys at some frames within `span`, by default the range of the keys."""
    return _with_keys(layer, retime.with_reversed_keys(layer.keys, frames, span))


@layer_command(_("Scale time of keys"))
def scale_keys(
    layer: Layer, frames: Collection[int], factor: float, first: int | None = None
) -> Layer:
    """Scale the frames of some keys around `first`, by default the first of the keys."""
    keys = retime.with_scaled_keys(layer.keys, frames, factor, first)
    stays = min(frames, default=0) if first is None else first
    return _rearranged(layer, keys, frames, TimeScale(stays, factor))


@layer_command(_("Make last key equal first"))
def match_loop_ends(layer: Layer) -> Layer:
    first, last = layer.keys[0], layer.keys[-1]
    if first is last:
        raise LissomError(_("A loop needs two keys; insert a second one first."))
    if first.pose is last.pose:
        return layer
    return replace_keys(layer, {last.frame: replace(last, pose=first.pose)})


@layer_command(_("Set easing"))
def set_easing(layer: Layer, frames: Collection[int], easing: Easing) -> Layer:
    """Set the easing from the keys at some frames to the next keys."""
    return _with_keys(layer, retime.with_easing(layer.keys, frames, easing))


@layer_command(_("Set tangent"))
def set_tangent_mode(layer: Layer, frames: Collection[int], passing: TangentMode) -> Layer:
    """Set the tangent mode of the keys at some frames; a hold ends."""
    return _with_keys(layer, retime.with_tangent_mode(layer.keys, frames, passing))


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


def _with_keys(
    layer: Layer, keys: tuple[Keyframe, ...], cycles: tuple[Cycle, ...] | None = None
) -> Layer:
    if keys is layer.keys:
        return layer
    return replace(layer, keys=keys, cycles=layer.cycles if cycles is None else cycles)


def _rearranged(
    layer: Layer,
    keys: tuple[Keyframe, ...],
    frames: Collection[int],
    to: Callable[[int], int],
) -> Layer:
    """Return the layer with keys moved, and their cycles and motion presets moved with them."""
    if keys is layer.keys:
        return layer
    changed = replace(layer, keys=keys, cycles=_moved_cycles(layer, frames, to), motions=())
    return replace(changed, motions=_carried_motions(layer, changed, frames, to))


def _carried_motions(
    layer: Layer, changed: Layer, frames: Collection[int], to: Callable[[int], int]
) -> tuple[AppliedMotion, ...]:
    """Return a layer's motion presets with their ends moved with the keys.

    A motion preset that would contain other keys or overlap another preset is dropped, since
    applying it again would delete these keys. A preset that moves as a whole stays unedited.
    """
    gone = {frame: to(frame) for frame in frames}
    motions: list[AppliedMotion] = []
    for motion in layer.motions:
        own = {frame for frame in layer.key_frames if motion.first <= frame <= motion.last}
        is_whole = bool(own) and own <= gone.keys()
        ends = (motion.first, motion.start, motion.last)
        first, start, last = (to(end) if is_whole else gone.get(end, end) for end in ends)
        if (first, start, last) == ends:
            motions.append(motion)
            continue
        others = {gone.get(frame, frame) for frame in layer.key_frames - own}
        if not first <= start < last or any(first <= frame <= last for frame in others):
            continue
        moved = replace(motion, first=first, start=start, last=last)
        is_shifted = is_whole and len({to(frame) - frame for frame in {*own, *ends}}) == 1
        if is_shifted and is_motion_unedited(layer, motion):
            moved = replace(moved, digest=digest_keys(changed, first, last))
        motions.append(moved)
    motions.sort(key=lambda motion: motion.first)
    apart = [before.last <= after.first for before, after in pairwise(motions)]
    return tuple(compress(motions, [True, *apart]))


def _moved_cycles(
    layer: Layer, frames: Collection[int], to: Callable[[int], int]
) -> tuple[Cycle, ...]:
    """Return a layer's cycles; a cycle moves if all its keys move."""
    cycles = []
    for cycle in layer.cycles:
        own = {frame for frame in layer.key_frames if cycle.contains(frame)}
        cycles.append(cycle.retimed(to) if own and own <= set(frames) else cycle)
    return tuple(sorted(cycles, key=lambda cycle: cycle.first))


def with_scaled_time(layer: Layer, scale: TimeScale) -> Layer:
    """Return the layer with all of its frames scaled; springs keep their frequencies in seconds."""
    return replace(
        layer,
        visibility_keys=scale.retimed(
            layer.visibility_keys,
            _("visibility keys of {layer!r}").format(layer=layer.name),
            _at_frame,
        ),
        attachments=scale.retimed(
            layer.attachments,
            _("attachments of {layer!r}").format(layer=layer.name),
            lambda joint, _: joint.retimed(scale),
        ),
        keys=scale.paced(layer.keys, _("keys of {layer!r}").format(layer=layer.name)),
        cycles=tuple(cycle.retimed(scale) for cycle in layer.cycles),
        motions=tuple(
            motion.moved(scale)
            for motion in layer.motions
            if scale(motion.start) < scale(motion.last)
        ),
        tracks=tuple(
            replace(
                track,
                keys=scale.paced(track.keys, _("track keys of {layer!r}").format(layer=layer.name)),
                delay=retime.nearest_frame(scale.factor * track.delay),
            )
            for track in layer.tracks
        ),
        transform_keys=scale.paced(
            layer.transform_keys, _("movement keys of {layer!r}").format(layer=layer.name)
        ),
        opacity_keys=scale.paced(
            layer.opacity_keys, _("opacity keys of {layer!r}").format(layer=layer.name)
        ),
        draw_order_keys=scale.retimed(
            layer.draw_order_keys,
            _("draw order keys of {layer!r}").format(layer=layer.name),
            _at_frame,
        ),
    )


def _at_frame(key: Held, frame: int) -> Held:
    return replace(key, frame=frame)
