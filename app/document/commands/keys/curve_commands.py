"""Commands on points of curves: move and scale in time and value, and turn tangents."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from app.document.channels.kind import Channel, KeysByChannel
from app.document.commands.command import command
from app.document.commands.keys import channel_commands
from app.document.commands.keys.retime import TimeScale
from app.document.commands.keys.stored_keys import put_rows
from app.document.model import Document
from app.document.queries.channel_values.channel_keys import keys_in
from app.document.queries.channel_values.curve_tangents import (
    Side,
    TangentHandle,
    find_velocity,
    with_tangent_handle,
    with_velocity,
)
from app.document.queries.channel_values.curves import ChannelCurve
from app.texts import _

# A curve, and the frame of a key of its channel.
Point = tuple[ChannelCurve, int]


@command(_("Move keys"))
def move_points(
    document: Document,
    keys: KeysByChannel,
    points: Iterable[Point],
    by: int,
    changes: Mapping[str, float],
    *,
    copies: bool = False,
) -> Document:
    """Move keys, or copies of them, by frames, and some of their numbers by `changes`, by unit."""
    change = channel_commands.copy_keys if copies else channel_commands.move_keys
    document = change(keys, by)(document) if by else document
    moved = [(curve, frame + by) for curve, frame in points if changes.get(curve.unit)]
    return _with_numbers(document, moved, lambda curve, number: number + changes[curve.unit])


@command(_("Scale keys"))
def scale_points(
    document: Document,
    keys: KeysByChannel,
    points: Iterable[Point],
    scale: TimeScale | None,
    fixed: Mapping[str, float],
    factor: float,
) -> Document:
    """Scale the time of keys, and some of their numbers around the fixed ones, by unit.

    The velocities of the numbers scale with them.
    """
    if scale is not None:
        document = channel_commands.scale_keys(keys, scale.factor, scale.stays)(document)
    placed = [
        (curve, frame if scale is None else scale(frame))
        for curve, frame in points
        if curve.unit in fixed
    ]
    return _with_numbers(
        document,
        placed,
        lambda curve, number: fixed[curve.unit] + factor * (number - fixed[curve.unit]),
        factor,
    )


@command(_("Set tangent"))
def move_tangent(
    document: Document, curve: ChannelCurve, frame: int, side: Side, handle: TangentHandle
) -> Document:
    """Move a handle of a key's tangent to a place relative to the key."""
    index = [key.frame for key in keys_in(document, curve.channel)].index(frame)
    changed = with_tangent_handle(document, curve, index, side, handle)
    row = channel_commands.with_changed_keys(document, curve.channel, changed)
    return put_rows(document, {curve.channel: row})


@command(_("Set velocity"))
def change_velocities(
    document: Document, points: Iterable[Point], changes: Mapping[str, float]
) -> Document:
    """Change the velocities of smooth keys, per frame, by `changes`, by unit."""
    for curve, frame in points:
        if not changes.get(curve.unit):
            continue
        index = [key.frame for key in keys_in(document, curve.channel)].index(frame)
        velocity = find_velocity(document, curve, index) + changes[curve.unit]
        changed = with_velocity(document, curve, index, velocity)
        row = channel_commands.with_changed_keys(document, curve.channel, changed)
        document = put_rows(document, {curve.channel: row})
    return document


def _with_numbers(
    document: Document,
    points: Iterable[Point],
    change: Callable[[ChannelCurve, float], float],
    factor: float = 1.0,
) -> Document:
    """Return a document with changed numbers of keys; their velocities scale by a factor."""
    rows: dict[Channel[Any], dict[int, Any]] = {}
    changed: dict[Channel[Any], dict[int, Any]] = {}
    for curve, frame in points:
        if curve.is_timing:
            continue
        channel = curve.channel
        if channel not in rows:
            rows[channel] = {key.frame: key for key in keys_in(document, channel)}
        number = curve.number_at_key(document, rows[channel][frame])
        key = curve.with_number(rows[channel][frame], change(curve, number), factor)
        rows[channel][frame] = changed.setdefault(channel, {})[frame] = key
    return put_rows(
        document,
        {
            channel: channel_commands.with_changed_keys(document, channel, keys)
            for channel, keys in changed.items()
        },
    )
