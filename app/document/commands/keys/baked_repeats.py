"""Repeats of channels and tracks as keys."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any, TypeVar

from app.document.channels.cycles import Cycle
from app.document.channels.key import Key
from app.document.channels.kind import ChannelKeys, ChannelKind
from app.document.channels.kinds import LAYER_KINDS
from app.document.channels.tangent_mode import TangentMode
from app.document.channels.tracks import Track, TrackKey
from app.document.commands.keys.retime import sorted_by_frame
from app.document.layer import Layer
from app.document.model import Document
from app.document.queries.channel_values.repeats import (
    held_key_at,
    repeated_keys,
    repeating_cycle,
    rest_value,
)
from app.document.queries.channel_values.tracks_at import track_at, velocity_at
from app.document.queries.channel_values.values_at import interpolated_value
from app.document.queries.clips import clip_of
from app.errors import LissomError
from app.texts import _

# Pixels and radians. A track with smaller values at its ends does not move the handle there.
SAME_POSE_DISTANCE = 1e-6

V = TypeVar("V")


def baked_channels(
    document: Document,
    layer: Layer,
    cycle: Cycle,
    until: int,
    left: tuple[Cycle, ...] = (),
) -> ChannelKeys:
    """Return a layer's channels with their keys in each repeat until a frame, if they repeat.

    Keys that do not repeat with `cycle` do not begin to repeat with the cycles that are left.
    """
    baked: dict[tuple[str, int | str | None], tuple[Key[Any], ...]] = {}
    for (name, part), keys in layer.channels.items():
        kind, row = LAYER_KINDS[name], keys
        if not kind.is_held:
            row = _copied(document, layer, kind, keys, cycle, until, left=left)
        else:
            rest = rest_value(layer, kind, part)
            row = repeated_keys(keys, (cycle,), until, rest)
            own = {key.frame: key for key in row}
            row = tuple(
                own.get(key.frame) or replace(held_key_at(row, key.frame) or key, frame=key.frame)
                for key in repeated_keys(row, left, until, rest)
            )
        baked[name, part] = row
    return baked


def _copied(
    document: Document,
    layer: Layer,
    kind: ChannelKind[V],
    keys: tuple[Key[V], ...],
    cycle: Cycle,
    until: int,
    *,
    left: tuple[Cycle, ...],
) -> tuple[Key[V], ...]:
    """Return interpolated keys with copies in each repeat until a frame, if they repeat.

    Keys that do not fill the cycle get keys at both ends of its repeats, with the values there.
    Keys that would begin to repeat with a cycle that is left get a key at the end of its repeats.
    """
    if repeating_cycle(kind, keys, layer.cycles) is not cycle:
        ends = {until} if repeating_cycle(kind, keys, left) else set[int]()
        return sorted_by_frame((*keys, *_keys_at(document, layer, kind, keys, ends)))
    first, last = keys[0], keys[-1]
    is_whole = last.frame - first.frame == cycle.period
    copies: list[Key[V]] = []
    for count, at in enumerate(range(0, until - cycle.first + 1, cycle.period)):
        for key in keys[:-1] if is_whole else keys:
            # A rotation that grows from repeat to repeat keeps growing.
            grown = [
                each.value_of(key)
                + (count * (each.value_of(last) - each.value_of(first)) if each.period else 0)
                for each in kind.components
            ]
            copy = replace(key, frame=key.frame + at)
            if is_whole and count:
                copy = replace(copy, value=kind.join(*grown))
            copies += [copy] if copy.frame <= until else []
    ends = {cycle.first, until} - {key.frame for key in copies}
    return sorted_by_frame((*copies, *_keys_at(document, layer, kind, keys, ends)))


def _keys_at(
    document: Document,
    layer: Layer,
    kind: ChannelKind[V],
    keys: tuple[Key[V], ...],
    frames: Iterable[int],
) -> Iterator[Key[V]]:
    """Yield corners with the interpolated values of keys at some frames."""
    for frame in frames:
        value = interpolated_value(document, kind, keys, frame, layer.cycles)
        if value is not None:
            yield kind.key(frame, value, tangent_mode=TangentMode.CORNER)


def baked_track(document: Document, layer: Layer, track: Track, cycle: Cycle, until: int) -> Track:
    """Return a track with its keys in each repeat until a frame, at the frames that show them."""
    first, last = track.keys[0], track.keys[-1]
    is_whole = first.frame == cycle.first and last.frame == cycle.last
    acts = [max(abs(key.place), abs(key.turn)) > SAME_POSE_DISTANCE for key in (first, last)]
    if not is_whole and until > cycle.last and (track.is_scene_space or any(acts)):
        raise LissomError(
            _(
                "The track of {handle!r} covers only a part of {cycle}, so its repeats cannot "
                "become keys of one track. Extend it from frame {first} to {last}, or let it "
                "start and end at the handle's position in the pose."
            ).format(
                handle=layer.handle(track.handles[0]).name,
                cycle=cycle.description,
                first=cycle.first,
                last=cycle.last,
            )
        )
    # If the track fills the cycle, its last key equals its first.
    own = track.keys[:-1] if is_whole else track.keys
    delay = track.delay % cycle.period
    keys = {
        key.frame + at: replace(key, frame=key.frame + at)
        for at in range(delay and delay - cycle.period, until - cycle.first + 1, cycle.period)
        for key in own
        if cycle.first <= key.frame + at <= until
    }
    clip = clip_of(document, layer.id)
    for at in {cycle.first, until} - keys.keys():
        sample = track_at(replace(track, enabled=True), clip, at)
        if sample is not None:
            velocity = velocity_at(track, clip, at)
            keys[at] = TrackKey(
                frame=at,
                place=sample.place,
                turn=sample.turn,
                velocity=velocity,
                tangent_mode=TangentMode.CORNER,
            )
    return replace(track, keys=sorted_by_frame(keys.values()), delay=0)
