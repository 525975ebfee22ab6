"""All channels of a document, with their keys."""

from collections.abc import Iterator
from typing import Any, TypeVar

from app.document.channels.cycles import Cycle
from app.document.channels.key import BaseKey
from app.document.channels.kind import Channel, ChannelKind, KeysByChannel
from app.document.channels.kinds import (
    CAMERA,
    LAYER_KINDS,
    MARKER,
    PARENT,
    POSE,
    SWITCH,
    TRACK,
    VOLUME,
)
from app.document.channels.tracks import Track
from app.document.layer import Layer
from app.document.model import Document
from app.document.queries.channel_values.repeats import keyed_frame, switch_cycle
from app.texts import N_, _

V = TypeVar("V")
OF_LAYER = N_("{channel} of {owner!r}")


def pose_channel(layer: int) -> Channel[Any]:
    return Channel(POSE, layer)


def track_channel(layer: int, track: Track) -> Channel[Any]:
    """Return the channel of a track, by the track's first handle."""
    return Channel(TRACK, layer, track.handles[0])


def channels_of(layer: Layer) -> Iterator[Channel[Any]]:
    """Yield the channels of a layer that have keys, its poses first.

    A single parent from the first frame on is no channel.
    """
    yield pose_channel(layer.id)
    for track in layer.tracks:
        yield track_channel(layer.id, track)
    if layer.attachments[1:] or any(joint.frame for joint in layer.attachments):
        yield Channel(PARENT, layer.id)
    for name, part in layer.channels:
        yield Channel(LAYER_KINDS[name], layer.id, part)


def channels_in(document: Document) -> Iterator[Channel[Any]]:
    """Yield all channels of a document that have keys."""
    if document.markers:
        yield Channel(MARKER)
    if document.camera:
        yield Channel(CAMERA)
    for switch in document.switch_groups:
        if switch.keys:
            yield Channel(SWITCH, part=switch.name)
    for sound in document.sounds:
        if sound.keys:
            yield Channel(VOLUME, part=sound.name)
    for layer in document.layers:
        yield from channels_of(layer)


def keys_in(document: Document, channel: Channel[Any]) -> tuple[BaseKey, ...]:
    """Return the keys of a channel in the order of their frames; none if it does not exist."""
    if channel.layer is None:
        return _scene_keys(document, channel)
    layer = document.find_layer(channel.layer)
    return () if layer is None else layer_keys(layer, channel)


def layer_keys(layer: Layer, channel: Channel[Any]) -> tuple[BaseKey, ...]:
    """Return the keys of a channel of a layer, as `keys_in`."""
    if channel.kind is TRACK:
        tracks = (each.keys for each in layer.tracks if each.handles[0] == channel.part)
        return next(tracks, ())
    own: dict[ChannelKind[Any], tuple[BaseKey, ...]] = {POSE: layer.keys, PARENT: layer.attachments}
    return own[channel.kind] if channel.kind in own else layer.channels.get(channel.id, ())


def _scene_keys(document: Document, channel: Channel[Any]) -> tuple[BaseKey, ...]:
    if channel.kind is SWITCH:
        groups = {each.name: each.keys for each in document.switch_groups}
        return groups.get(str(channel.part), ())
    if channel.kind is VOLUME:
        return next((each.keys for each in document.sounds if each.name == channel.part), ())
    return document.camera if channel.kind is CAMERA else document.markers


def track_in(document: Document, channel: Channel[Any]) -> Track | None:
    """Return the track of a channel; None for another channel or a missing track."""
    layer = None if channel.layer is None else document.find_layer(channel.layer)
    if layer is None or channel.kind is not TRACK or not isinstance(channel.part, int):
        return None
    track = layer.track_of(channel.part)
    return track if track is not None and track.handles[0] == channel.part else None


def frames_in(document: Document, channel: Channel[Any]) -> frozenset[int]:
    """Return the frames of a channel's keys, without the delay of a track."""
    return frozenset(key.frame for key in keys_in(document, channel))


def all_keys(document: Document) -> KeysByChannel:
    """Return the frames of all keys of a document."""
    return {channel: frames_in(document, channel) for channel in channels_in(document)}


def describe_channel(document: Document, channel: Channel[Any]) -> str:
    """Return the name of a channel with its owner, for messages."""
    owner = channel.part if isinstance(channel.part, str) else None
    layer = None if channel.layer is None else document.find_layer(channel.layer)
    if layer is not None:
        owner = layer.name
        if isinstance(channel.part, int):
            names = {handle.id: handle.name for handle in layer.handles}
            owner = names.get(channel.part, owner)
    label = str(channel.part) if channel.kind.of_sliders else _(channel.kind.label)
    return label if owner is None else _(OF_LAYER).format(channel=label, owner=owner)


def cycles_of(document: Document, channel: Channel[Any]) -> tuple[Cycle, ...]:
    """Return the cycles with which a channel may repeat."""
    if channel.kind is SWITCH:
        group = next((each for each in document.switch_groups if each.name == channel.part), None)
        cycle = None if group is None else switch_cycle(document, group)
        return () if cycle is None else (cycle,)
    layer = None if channel.layer is None else document.find_layer(channel.layer)
    return () if layer is None else layer.cycles


def source_frame(document: Document, channel: Channel[Any], frame: int) -> int | None:
    """Return the frame of a key that is shown at a frame, in repeats an earlier one.

    The delay of a track is left out. None if a track cannot have a key there.
    """
    layer = None if channel.layer is None else document.find_layer(channel.layer)
    match channel.kind.name:
        case POSE.name if layer is not None:
            return layer.source_of(frame)
        case PARENT.name if layer is not None:
            return layer.joint_frame(frame)
        case TRACK.name:
            track = track_in(document, channel)
            return frame if track is None else track_source_frame(document, track, frame)
        case SWITCH.name:
            repeats = [each for each in cycles_of(document, channel) if each.covers(frame)]
            held = [each for each in repeats if frame != each.until]
            return int(held[0].source_frame(frame)) if held else frame
    keys = () if layer is None else layer.channels.get(channel.id, ())
    cycles = () if layer is None else layer.cycles
    return keyed_frame(channel.kind, keys, cycles, frame)


def display_frame(document: Document, channel: Channel[Any], frame: int) -> int:
    """Return the shown frame of a key; a track's delay is added.

    The frame wraps around in a loop, and in a cycle that repeats the track.
    """
    track = track_in(document, channel)
    return frame if track is None else track_display_frame(document, track, frame)


def track_display_frame(document: Document, track: Track, frame: int) -> int:
    """Return the shown frame of a track's key, as `display_frame`."""
    seen, cycle = frame + track.delay, _cycle_of(document, track)
    if cycle is not None:
        return seen if seen <= cycle.last else int(cycle.source_frame(seen))
    first, last = document.frames.first, document.frames.last
    return seen - (last - first) if document.loop and seen > last else seen


def track_source_frame(document: Document, track: Track, seen: int) -> int | None:
    """Return the key frame for a shown frame of a track; None if none is possible."""
    first, last = document.frames.first, document.frames.last
    own, cycle = seen - track.delay, _cycle_of(document, track)
    if cycle is not None and cycle.covers(seen):
        return own if own in track.key_frames else int(cycle.source_frame(own))
    if own < first and document.loop:
        own += last - first
    return None if own < first else own


def _cycle_of(document: Document, track: Track) -> Cycle | None:
    """Return the cycle that repeats a track, if there is one."""
    layer = next((each for each in document.layers if track in each.tracks), None)
    cycles = () if layer is None else layer.cycles
    return next((cycle for cycle in cycles if cycle.repeats_keys(track.keys)), None)
