"""Commands on tracks as wholes, and on springs.

Any handle of a track identifies the track. Its keys are at their own frames, without the delay.
"""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from typing import Any

from app.document.channels.easing import LINEAR, Easing
from app.document.channels.springs import Spring
from app.document.channels.tracks import Track, TrackKey
from app.document.commands.command import layer_command
from app.document.commands.keys import (
    retime,
)
from app.document.commands.keys.track_handles import (
    mirrored_track,
    track_for_handles,
    track_without_handles,
)
from app.document.layer import Layer
from app.document.rig.mirror_names import PAIRS, SidePairs
from app.errors import LissomError
from app.texts import _


@layer_command(_("Set track"))
def put_track(layer: Layer, track: Track) -> Layer:
    """Give handles a track; they leave their former tracks, and empty tracks are deleted."""
    return _with_track(layer, track)


@layer_command(_("Delete track"))
def remove_tracks(layer: Layer, handles: Collection[int]) -> Layer:
    gone = [_track(layer, handle) for handle in handles]
    return _with_tracks(layer, (track for track in layer.tracks if track not in gone))


@layer_command(_("Key handle"))
def put_track_key(
    layer: Layer,
    handle: int,
    frame: int,
    place: complex,
    *,
    turn: float | None = None,
    velocity: complex | None = None,
    easing: Easing = LINEAR,
    planted: bool = False,
) -> Layer:
    """Set the position of a track key at a frame, or insert a key or a track.

    Parameters
    ----------
    place : complex
        In the space of the track: relative to the pose, or in the picture.
    turn : float, optional
        In radians. None keeps the key's own, or 0 for a new key.
    velocity : complex, optional
        Of a new key, in pixels per frame. An existing key keeps its own.
    easing : Easing
        Of new segments, as in `key_commands.insert_key`.
    planted : bool
        Whether a new track is in scene space.
    """
    track = layer.track_of(handle)
    if track is not None and frame in track.key_frames:
        (key,) = retime.keys_at_frames(track.keys, {frame})
        changed = replace(key, place=place, turn=key.turn if turn is None else turn)
        return _with_keys(layer, track, retime.with_overwritten_keys(track.keys, (changed,)))
    key = TrackKey(frame=frame, place=place, turn=turn or 0.0, velocity=velocity, easing=easing)
    if track is not None:
        return _with_keys(layer, track, retime.with_inserted_key(track.keys, key))
    layer.handle(handle)
    return _with_track(layer, Track(handles=(handle,), is_scene_space=planted, keys=(key,)))


@layer_command(_("Set delay"))
def set_delay(layer: Layer, handle: int, delay: int) -> Layer:
    return _with(layer, handle, delay=delay)


@layer_command(_("Set reach"))
def set_reach(layer: Layer, handle: int, reach: float) -> Layer:
    """Set how far a track's displacement spreads around its handles, from 0 to 1."""
    return _with(layer, handle, reach=float(reach))


@layer_command(_("Set rotation"))
def set_turning(layer: Layer, handle: int, *, turns: bool) -> Layer:
    """Set whether a track rotates the shape at its handles."""
    return _with(layer, handle, keys_rotation=turns)


@layer_command(_("Switch track on or off"))
def enable_track(layer: Layer, handle: int, *, enabled: bool) -> Layer:
    """Turn a track on or off; its keys stay."""
    return _with(layer, handle, enabled=enabled)


@layer_command(_("Plant track"))
def plant_track(
    layer: Layer,
    handle: int,
    places: Sequence[complex],
    velocities: Sequence[complex | None] | None = None,
    *,
    planted: bool,
) -> Layer:
    """Change a track to scene space, or back to pose space.

    `app.motion` computes `places` and `velocities`, the values of the keys in the new space.
    Without velocities the keys lose their own.
    """
    track = _track(layer, handle)
    velocities = velocities or [None] * len(places)
    if not len(places) == len(velocities) == len(track.keys):
        raise LissomError(
            _("The track has {count} keys, but there are {given} positions for them.").format(
                count=len(track.keys), given=len(places)
            )
        )
    keys = tuple(
        replace(key, place=place, velocity=velocity)
        for key, place, velocity in zip(track.keys, places, velocities, strict=True)
    )
    return _with(layer, handle, is_scene_space=planted, keys=keys)


@layer_command(_("Set handles of track"))
def set_track_handles(layer: Layer, handle: int, handles: Sequence[int]) -> Layer:
    """Set the handles of a track; its keys belong to the first."""
    track = _track(layer, handle)
    return _with_track(layer, track_for_handles(layer, track, tuple(handles)), instead=track)


@layer_command(_("Copy track"))
def copy_track(layer: Layer, handle: int, to: int) -> Layer:
    return _with_track(layer, track_for_handles(layer, _track(layer, handle), (to,)))


@layer_command(_("Copy track mirrored"))
def mirror_track(layer: Layer, handle: int, pairs: SidePairs = PAIRS) -> Layer:
    """Copy a handle's track, mirrored, to the handles on the other side.

    The track of a handle without a partner is mirrored in place.
    """
    return _with_track(layer, mirrored_track(layer, _track(layer, handle), pairs))


@layer_command(_("Set spring"))
def put_spring(layer: Layer, spring: Spring) -> Layer:
    if layer.spring_of(spring.handle) == spring:
        return layer
    others = tuple(each for each in layer.springs if each.handle != spring.handle)
    return replace(layer, springs=(*others, spring))


@layer_command(_("Delete spring"))
def remove_springs(layer: Layer, handles: Collection[int]) -> Layer:
    springs = tuple(spring for spring in layer.springs if spring.handle not in handles)
    return layer if springs == layer.springs else replace(layer, springs=springs)


def _track(layer: Layer, handle: int) -> Track:
    track = layer.track_of(handle)
    if track is None:
        raise LissomError(
            _("The handle {handle!r} has no track.").format(handle=layer.handle(handle).name)
        )
    return track


def _with_track(layer: Layer, track: Track, *, instead: Track | None = None) -> Layer:
    """Return the layer with a track added or replaced; its handles leave their former tracks."""
    for handle in track.handles:
        layer.handle(handle)
    same = (each for each in layer.tracks if each.handles == track.handles)
    instead = instead or next(same, None)
    tracks = [
        track if each is instead else track_without_handles(layer, each, track.handles)
        for each in layer.tracks
    ]
    return _with_tracks(layer, filter(None, tracks if instead else [*tracks, track]))


def _with_tracks(layer: Layer, tracks: Iterable[Track]) -> Layer:
    """Return the layer with these tracks, the same object without a change."""
    given = tuple(tracks)
    return layer if given == layer.tracks else replace(layer, tracks=given)


def _with_keys(layer: Layer, track: Track, keys: tuple[TrackKey, ...]) -> Layer:
    return _with_track(layer, replace(track, keys=keys), instead=track)


def _with(layer: Layer, handle: int, **changes: Any) -> Layer:
    track = _track(layer, handle)
    return _with_track(layer, replace(track, **changes), instead=track)
