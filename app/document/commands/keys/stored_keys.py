"""Where a document stores the keys of each channel."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from app.document.channels.key import BaseKey
from app.document.channels.kind import Channel
from app.document.channels.kinds import CAMERA, MARKER, PARENT, POSE, SWITCH, TRACK, VOLUME
from app.document.layer import Layer
from app.document.model import Document
from app.document.settings import FrameRange
from app.errors import LissomError
from app.texts import N_, _

NO_POSE_KEY = N_("An animation needs at least one key. Change the pose of the last key instead.")
NO_CHANNEL = N_("{channel}: this channel no longer exists.")
KeyRow = tuple[Any, ...]
KeyRows = Mapping[Channel[Any], KeyRow]
Fields = dict[str, Any]
NO_FIELDS: Mapping[int, Fields] = {}


def put_keys(document: Document, channel: Channel[Any], keys: Iterable[BaseKey]) -> Document:
    """Return a document with other keys of a channel, the same object without a change."""
    return put_rows(document, {channel: tuple(keys)})


def put_rows(
    document: Document, rows: KeyRows, changes: Mapping[int, Fields] = NO_FIELDS, **scene: Any
) -> Document:
    """Return a document with other keys of several channels, the same object without a change.

    The document's frames grow to contain keys that are interpolated. A track without keys is
    deleted; the poses of a layer need a key.

    Parameters
    ----------
    changes : mapping
        Other fields that change at once, by layer id.
    scene
        Other fields of the document.
    """
    by_layer: dict[int, dict[Channel[Any], KeyRow]] = {identity: {} for identity in changes}
    for channel, row in rows.items():
        if channel.layer is not None:
            by_layer.setdefault(channel.layer, {})[channel] = row
    changed = {
        identity: _with_fields(
            document.layer(identity),
            {**_layer_fields(document.layer(identity), own), **changes.get(identity, {})},
        )
        for identity, own in by_layer.items()
    }
    if any(layer is not document.layer(identity) for identity, layer in changed.items()):
        layers = tuple(changed.get(layer.id, layer) for layer in document.layers)
        scene = {"layers": layers, **scene}
    scene = {**_scene_fields(document, rows), **scene}
    if not scene:
        return document
    ends = [key.frame for key in scene.get("camera", ())]
    ends += [frame for layer in changed.values() for frame in layer.keyed_range]
    frames: FrameRange = scene.get("frames", document.frames)
    ends += [frames.first, frames.last]
    return replace(document, **{**scene, "frames": FrameRange(min(ends), max(ends))})


def _scene_fields(document: Document, rows: KeyRows) -> Fields:
    """Return the changed fields of a document for the keys of its own channels."""
    fields: Fields = {}
    groups = {each.name: each for each in document.switch_groups}
    sounds = {each.name: each for each in document.sounds}
    for channel, row in rows.items():
        if channel.kind is MARKER and row != document.markers:
            fields["markers"] = row
        elif channel.kind is CAMERA and row != document.camera:
            fields["camera"] = row
        elif channel.kind is SWITCH:
            group = document.switch_group(str(channel.part))
            groups[group.name] = replace(group, keys=row)
        elif channel.kind is VOLUME:
            sound = document.sound(str(channel.part))
            sounds[sound.name] = replace(sound, keys=row)
    if tuple(groups.values()) != document.switch_groups:
        fields["switch_groups"] = tuple(groups.values())
    if tuple(sounds.values()) != document.sounds:
        fields["sounds"] = tuple(sounds.values())
    return fields


def _layer_fields(layer: Layer, rows: KeyRows) -> Fields:
    """Return the fields of a layer for the keys of its channels."""
    fields: Fields = {}
    tracks = {track.handles[0]: track for track in layer.tracks}
    channels = dict(layer.channels)
    for channel, row in rows.items():
        if channel.kind is POSE:
            if not row:
                raise LissomError(_(NO_POSE_KEY))
            fields["keys"] = row
        elif channel.kind is PARENT:
            fields["attachments"] = row
        elif channel.kind is TRACK:
            if channel.part not in tracks:
                raise LissomError(_(NO_CHANNEL).format(channel=_(TRACK.label)))
            track = tracks.pop(channel.part) if not row else tracks[channel.part]
            if row:
                tracks[channel.part] = replace(track, keys=row)
        else:
            channels[channel.id] = row
    return {**fields, "tracks": tuple(tracks.values()), "channels": channels}


def _with_fields(layer: Layer, fields: Fields) -> Layer:
    """Return a layer with other fields, the same object without a change."""
    kept = {name: keys for name, keys in fields.pop("channels", layer.channels).items() if keys}
    changed = {name: value for name, value in fields.items() if value != getattr(layer, name)}
    if kept != layer.channels:
        changed["channels"] = kept
    return replace(layer, **changed) if changed else layer
