"""Commands on keys of any channels: set, move, copy, delete, reverse, scale, ease.

`keys` are the frames of keys by channel. Keys keep what they need to be exact: velocities scale
with time, and cycles and motion presets move with the poses that they consist of.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

from app.document.channels.easing import Easing
from app.document.channels.key import BaseKey, Key
from app.document.channels.kind import Channel, KeysByChannel
from app.document.channels.kinds import MARKER, OPACITY, POSE, SWITCH
from app.document.channels.tangent_mode import TangentMode
from app.document.commands.command import command
from app.document.commands.keys import (
    moved_poses,
    retime,
)
from app.document.commands.keys.retime import TimeScale
from app.document.commands.keys.stored_keys import Fields, KeyRow, put_keys, put_rows
from app.document.model import Document
from app.document.queries.channel_values.channel_keys import (
    cycles_of,
    describe_channel,
    keys_in,
    source_frame,
)
from app.document.queries.channel_values.repeats import repeating_cycle
from app.texts import _


@command(_("Set key"))
def set_key(document: Document, channel: Channel[Any], frame: int, value: Any) -> Document:
    """Set the value of a channel at a frame; an existing key keeps its easing and tangent mode.

    In repeats, the key that repeats is set. If it begins a cycle that ends with the same state, the
    key at the end changes with it, and full turns between them stay.
    """
    keys, kind = _row(document, channel), channel.kind
    at = source_frame(document, channel, frame)
    at = frame if at is None else at
    old = next((key for key in keys if key.frame == at), None)
    if old is None:
        new = kind.key(at, value)
        return put_keys(document, channel, retime.with_inserted_key(keys, new))
    return put_keys(
        document, channel, with_changed_keys(document, channel, {at: replace(old, value=value)})
    )


def with_changed_keys(
    document: Document, channel: Channel[Any], changed: Mapping[int, Any]
) -> KeyRow:
    """Return the keys of a channel, of which some have other values or tangents.

    If the first key begins a cycle that ends with the same state, the key at the end changes with
    it, and full turns between them stay.
    """
    keys, kind = _row(document, channel), channel.kind
    cycle = repeating_cycle(kind, keys, cycles_of(document, channel)) if kind.components else None
    first, last = keys[0], keys[-1]
    is_alone = first.frame in changed and last.frame not in changed
    if cycle is not None and is_alone and last.frame == first.frame + cycle.period:
        begun = changed[first.frame]
        moved = _components(channel, begun), _components(channel, first)
        ends = _components(channel, last)
        values = [
            new + each - before if component.period else new
            for component, new, before, each in zip(kind.components, *moved, ends, strict=True)
        ]
        end = replace(last, value=kind.join(*values), velocities=begun.velocities)
        changed = {**changed, last.frame: end}
    return retime.with_replaced_keys(keys, changed)


def _components(channel: Channel[Any], key: Key[Any]) -> list[Any]:
    return [component.value_of(key) for component in channel.kind.components]


@command(_("Paste keys"))
def insert_keys(document: Document, keys: Mapping[Channel[Any], Sequence[BaseKey]]) -> Document:
    """Put keys of several channels at their frames, in place of existing keys."""
    return put_rows(
        document,
        {
            channel: retime.with_overwritten_keys(_row(document, channel), given)
            for channel, given in keys.items()
        },
    )


@command(_("Move keys"))
def move_keys(document: Document, keys: KeysByChannel, by: int) -> Document:
    """Move keys by a number of frames, with the cycles and motion presets of moved poses."""

    def moved(row: KeyRow, frames: Collection[int], _channel: Channel[Any]) -> KeyRow:
        return retime.with_moved_keys(row, frames, by)

    return _changed(document, keys, moved, lambda frame: frame + by)


@command(_("Copy keys"))
def copy_keys(document: Document, keys: KeysByChannel, by: int) -> Document:
    return _changed(
        document, keys, lambda row, frames, _channel: retime.with_copied_keys(row, frames, by)
    )


@command(_("Delete keys"))
def delete_keys(document: Document, keys: KeysByChannel) -> Document:
    """Delete keys; the poses of a layer need one. Cycles without keys are deleted.

    Without opacity keys, a layer keeps the opacity of its first one.
    """
    rows = {
        channel: retime.without_keys(_row(document, channel), frames)
        for channel, frames in keys.items()
    }
    changes: dict[int, Fields] = {}
    for channel, left in rows.items():
        if channel.layer is None:
            # The layer that was visible before a deleted key stays visible.
            rows[channel] = retime.without_repetitions(left) if channel.kind is SWITCH else left
            continue
        layer = document.layer(channel.layer)
        if channel.kind is POSE:
            cycles = moved_poses.cycles_with_keys(layer, left, keys[channel])
            changes.setdefault(layer.id, {})["cycles"] = cycles
        elif channel.kind is OPACITY and not left:
            (first, *_later) = layer.keys_of(OPACITY)
            changes.setdefault(layer.id, {})["opacity"] = first.value
    return put_rows(document, rows, changes)


@command(_("Reverse keys"))
def reverse_keys(
    document: Document, keys: KeysByChannel, span: tuple[int, int] | None = None
) -> Document:
    """Reverse keys within `span`, by default the range of all of them."""
    every = [frame for frames in keys.values() for frame in frames]
    if not every:
        return document
    within = span or (min(every), max(every))

    def turned(row: KeyRow, frames: Collection[int], channel: Channel[Any]) -> KeyRow:
        # A marker names its own frame only, and nothing until the next one.
        is_held = channel.kind.is_held and channel.kind is not MARKER
        return retime.with_reversed_keys(row, frames, within, is_held=is_held)

    return _changed(document, keys, turned)


@command(_("Scale time of keys"))
def scale_keys(
    document: Document, keys: KeysByChannel, factor: float, first: int | None = None
) -> Document:
    """Scale the frames of keys around `first`, by default the first of them."""
    every = [frame for frames in keys.values() for frame in frames]
    scale = TimeScale(min(every, default=0) if first is None else first, factor)

    def scaled(row: KeyRow, frames: Collection[int], channel: Channel[Any]) -> KeyRow:
        return retime.with_scaled_keys(row, frames, scale, describe_channel(document, channel))

    return _changed(document, keys, scaled, scale)


@command(_("Set easing"))
def set_easing(document: Document, keys: KeysByChannel, easing: Easing) -> Document:
    """Set the easing from keys to the next keys; they lose their own velocities."""
    return _changed(
        document, _eased(keys), lambda row, frames, _c: retime.with_easing(row, frames, easing)
    )


@command(_("Set tangent"))
def set_tangent_mode(document: Document, keys: KeysByChannel, mode: TangentMode) -> Document:
    """Set the tangent mode of keys; a hold ends, and they lose their own velocities."""
    return _changed(
        document, _eased(keys), lambda row, frames, _c: retime.with_tangent_mode(row, frames, mode)
    )


def _eased(keys: KeysByChannel) -> KeysByChannel:
    """Return the keys of channels that are interpolated."""
    return {channel: at for channel, at in keys.items() if not channel.kind.is_held}


def _changed(
    document: Document,
    keys: KeysByChannel,
    change: Callable[[KeyRow, Collection[int], Channel[Any]], KeyRow],
    to: Callable[[int], int] | None = None,
) -> Document:
    """Change the keys of each channel; with `to`, cycles and presets move with their poses."""
    rows = {
        channel: change(_row(document, channel), frames, channel)
        for channel, frames in keys.items()
    }
    poses = {
        channel.layer: moved_poses.moved_fields(
            document.layer(channel.layer), rows[channel], frames, to
        )
        for channel, frames in keys.items()
        if to is not None and channel.kind is POSE and channel.layer is not None
    }
    return put_rows(document, rows, poses)


def _row(document: Document, channel: Channel[Any]) -> KeyRow:
    """Return the keys of a channel, of whatever class."""
    return keys_in(document, channel)
