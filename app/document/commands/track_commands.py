"""Commands on tracks and springs, the clocks of single handles.

A track is told by any of its handles. Its keys are at frames of its own, without its delay.
"""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from typing import Any

from app.document.commands import retime
from app.document.commands.command import layer_command
from app.document.commands.track_handles import (
    mirrored_track,
    track_for_handles,
    track_without_handles,
)
from app.document.layer import Layer
from app.document.rig import PAIRS, SidePairs
from app.document.timing import LINEAR, Easing, Spring, TangentMode, Track, TrackKey
from app.errors import LissomError


@layer_command("Set track")
def put_track(layer: Layer, track: Track) -> Layer:
    """Give handles a track; they leave those that they were in, which go where none is left."""
    return _with_track(layer, track)


@layer_command("Delete track")
def remove_tracks(layer: Layer, handles: Collection[int]) -> Layer:
    """Remove the tracks of some handles, and of those that they move with."""
    gone = [_track(layer, handle) for handle in handles]
    return _with_tracks(layer, (track for track in layer.tracks if track not in gone))


@layer_command("Key handle")
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
    """Give the key of a handle's track at a frame a place; where there is none, insert one.

    Parameters
    ----------
    place : complex
        As the track has it, beside the pose or in the picture.
    turn : float, optional
        In radians; None keeps that of the key, or is 0.
    velocity : complex, optional
        Of a new key, in pixels a frame; one that is there keeps its own.
    easing : Easing
        Of ways that are new, as `key_commands.insert_key` has it.
    planted : bool
        Of a new track, where the handle has none.
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


@layer_command("Paste keys of track")
def put_track_keys(layer: Layer, handle: int, keys: Sequence[TrackKey]) -> Layer:
    """Put keys at their frames in a handle's track, in place of those that are there."""
    track = _track(layer, handle)
    return _with_keys(layer, track, retime.with_overwritten_keys(track.keys, keys))


@layer_command("Move keys of track")
def move_track_keys(layer: Layer, handle: int, frames: Collection[int], by: int) -> Layer:
    """Move the keys of a track at some frames by a number of frames."""
    track = _track(layer, handle)
    return _with_keys(layer, track, retime.with_moved_keys(track.keys, frames, by))


@layer_command("Copy keys of track")
def copy_track_keys(layer: Layer, handle: int, frames: Collection[int], by: int) -> Layer:
    """Repeat the keys of a track at some frames a number of frames later, or earlier."""
    track = _track(layer, handle)
    return _with_keys(layer, track, retime.with_copied_keys(track.keys, frames, by))


@layer_command("Delete keys of track")
def delete_track_keys(layer: Layer, handle: int, frames: Collection[int]) -> Layer:
    """Delete the keys of a track at some frames; with the last one the track goes."""
    track = _track(layer, handle)
    keys = retime.without_keys(track.keys, frames)
    if not keys:
        return _with_tracks(layer, (each for each in layer.tracks if each is not track))
    return _with_keys(layer, track, keys)


@layer_command("Reverse keys of track")
def reverse_track_keys(
    layer: Layer, handle: int, frames: Collection[int], span: tuple[int, int] | None = None
) -> Layer:
    """Let a track run backwards between some of its keys, or in a span of frames."""
    track = _track(layer, handle)
    return _with_keys(layer, track, retime.with_reversed_keys(track.keys, frames, span))


@layer_command("Scale time of keys of track")
def scale_track_keys(
    layer: Layer, handle: int, frames: Collection[int], factor: float, first: int | None = None
) -> Layer:
    """Move keys of a track apart or together in time, around the first of them or a frame."""
    track = _track(layer, handle)
    return _with_keys(layer, track, retime.with_scaled_keys(track.keys, frames, factor, first))


@layer_command("Set easing")
def set_track_easing(layer: Layer, handle: int, frames: Collection[int], easing: Easing) -> Layer:
    """Set how time runs from the keys of a track at some frames to the next ones.

    They are passed at no velocity of their own any more.
    """
    track = _track(layer, handle)
    return _with_keys(layer, track, retime.with_easing(_unled(track, frames), frames, easing))


@layer_command("Set passing")
def set_track_passing(
    layer: Layer, handle: int, frames: Collection[int], passing: TangentMode
) -> Layer:
    """Set how a track passes its keys at some frames; one that held its place does no longer.

    None of them has a velocity of its own any more.
    """
    track = _track(layer, handle)
    return _with_keys(
        layer, track, retime.with_tangent_mode(_unled(track, frames), frames, passing)
    )


@layer_command("Set delay")
def set_delay(layer: Layer, handle: int, delay: int) -> Layer:
    """Set by how many frames a track is late."""
    return _with(layer, handle, delay=delay)


@layer_command("Set reach")
def set_reach(layer: Layer, handle: int, reach: float) -> Layer:
    """Set how far around a track's handles the body gives, from 0 to 1."""
    return _with(layer, handle, reach=float(reach))


@layer_command("Set turning")
def set_turning(layer: Layer, handle: int, *, turns: bool) -> Layer:
    """Let a track turn the shape at its handles, or leave that free."""
    return _with(layer, handle, turns=turns)


@layer_command("Switch track on or off")
def enable_track(layer: Layer, handle: int, *, enabled: bool) -> Layer:
    """Let a track act, or not; its keys stay."""
    return _with(layer, handle, enabled=enabled)


@layer_command("Plant track")
def plant_track(
    layer: Layer,
    handle: int,
    places: Sequence[complex],
    velocities: Sequence[complex | None] | None = None,
    *,
    planted: bool,
) -> Layer:
    """Let a track's keys be places in the picture, or beside the pose.

    Parameters
    ----------
    places, velocities : sequences of complex
        What the keys have then, in their order; `app.motion` knows it. Without velocities they have
        none of their own any more.
    """
    track = _track(layer, handle)
    velocities = velocities or [None] * len(places)
    if not len(places) == len(velocities) == len(track.keys):
        raise LissomError(f"The track has {len(track.keys)} keys, not {len(places)}.")
    keys = tuple(
        replace(key, place=place, velocity=velocity)
        for key, place, velocity in zip(track.keys, places, velocities, strict=True)
    )
    return _with(layer, handle, planted=planted, keys=keys)


@layer_command("Set handles of track")
def set_track_handles(layer: Layer, handle: int, handles: Sequence[int]) -> Layer:
    """Set which handles a track moves, the first of which its keys are of."""
    track = _track(layer, handle)
    return _with_track(layer, track_for_handles(layer, track, tuple(handles)), instead=track)


@layer_command("Copy track")
def copy_track(layer: Layer, handle: int, to: int) -> Layer:
    """Give another handle the track of a handle, so that it is moved alike from where it is."""
    return _with_track(layer, track_for_handles(layer, _track(layer, handle), (to,)))


@layer_command("Copy track mirrored")
def mirror_track(layer: Layer, handle: int, pairs: SidePairs = PAIRS) -> Layer:
    """Give the handles on the other side the track of a handle, mirrored.

    A handle without a partner keeps its track, and does its mirror image.
    """
    return _with_track(layer, mirrored_track(layer, _track(layer, handle), pairs))


@layer_command("Set spring")
def put_spring(layer: Layer, spring: Spring) -> Layer:
    """Let a handle follow by a spring, in place of the one that it has."""
    if layer.spring_of(spring.handle) == spring:
        return layer
    others = tuple(each for each in layer.springs if each.handle != spring.handle)
    return replace(layer, springs=(*others, spring))


@layer_command("Delete spring")
def remove_springs(layer: Layer, handles: Collection[int]) -> Layer:
    """Let handles follow no longer."""
    springs = tuple(spring for spring in layer.springs if spring.handle not in handles)
    return layer if springs == layer.springs else replace(layer, springs=springs)


def _track(layer: Layer, handle: int) -> Track:
    track = layer.track_of(handle)
    if track is None:
        raise LissomError(f"The handle {layer.handle(handle).name!r} has no track.")
    return track


def _unled(track: Track, frames: Collection[int]) -> tuple[TrackKey, ...]:
    """Return the keys of a track, those at some frames without a velocity of their own."""
    chosen = retime.keys_at_frames(track.keys, frames)
    return retime.with_replaced_keys(
        track.keys, {key.frame: key.without_velocity() for key in chosen}
    )


def _with_track(layer: Layer, track: Track, *, instead: Track | None = None) -> Layer:
    """Return the layer with a track, in place of another one; its handles leave theirs."""
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
    """Return the layer with these tracks, itself if it has them."""
    given = tuple(tracks)
    return layer if given == layer.tracks else replace(layer, tracks=given)


def _with_keys(layer: Layer, track: Track, keys: tuple[TrackKey, ...]) -> Layer:
    return _with_track(layer, replace(track, keys=keys), instead=track)


def _with(layer: Layer, handle: int, **changes: Any) -> Layer:
    track = _track(layer, handle)
    return _with_track(layer, replace(track, **changes), instead=track)
