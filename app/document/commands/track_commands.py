"""Commands on tracks and springs, the clocks of single handles.

A track is told by any of its handles. Its keys are at frames of its own, without its delay.
"""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from typing import Any

from app.document.body import PAIRS, SidePairs
from app.document.commands import keys_in_time
from app.document.commands.command import figure_command
from app.document.commands.track_handles import left, mirrored_track, moved_to
from app.document.figure import Figure
from app.document.timing import LINEAR, Easing, Passing, Spring, Track, TrackKey
from app.errors import LissomError


@figure_command("Set track")
def put_track(figure: Figure, track: Track) -> Figure:
    """Give handles a track; they leave those that they were in, which go where none is left."""
    return _with_track(figure, track)


@figure_command("Delete track")
def remove_tracks(figure: Figure, handles: Collection[int]) -> Figure:
    """Remove the tracks of some handles, and of those that they move with."""
    gone = [_track(figure, handle) for handle in handles]
    return _with_tracks(figure, (track for track in figure.tracks if track not in gone))


@figure_command("Key handle")
def put_track_key(
    figure: Figure,
    handle: int,
    frame: int,
    place: complex,
    *,
    turn: float | None = None,
    velocity: complex | None = None,
    easing: Easing = LINEAR,
    planted: bool = False,
) -> Figure:
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
    track = figure.track_of(handle)
    if track is not None and frame in track.key_frames:
        (key,) = keys_in_time.at_frames(track.keys, {frame})
        changed = replace(key, place=place, turn=key.turn if turn is None else turn)
        return _with_keys(figure, track, keys_in_time.put(track.keys, (changed,)))
    key = TrackKey(frame=frame, place=place, turn=turn or 0.0, velocity=velocity, easing=easing)
    if track is not None:
        return _with_keys(figure, track, keys_in_time.inserted(track.keys, key))
    figure.handle(handle)
    return _with_track(figure, Track(handles=(handle,), planted=planted, keys=(key,)))


@figure_command("Paste keys of track")
def put_track_keys(figure: Figure, handle: int, keys: Sequence[TrackKey]) -> Figure:
    """Put keys at their frames in a handle's track, in place of those that are there."""
    track = _track(figure, handle)
    return _with_keys(figure, track, keys_in_time.put(track.keys, keys))


@figure_command("Move keys of track")
def move_track_keys(figure: Figure, handle: int, frames: Collection[int], by: int) -> Figure:
    """Move the keys of a track at some frames by a number of frames."""
    track = _track(figure, handle)
    return _with_keys(figure, track, keys_in_time.moved(track.keys, frames, by))


@figure_command("Copy keys of track")
def copy_track_keys(figure: Figure, handle: int, frames: Collection[int], by: int) -> Figure:
    """Repeat the keys of a track at some frames a number of frames later, or earlier."""
    track = _track(figure, handle)
    return _with_keys(figure, track, keys_in_time.copied(track.keys, frames, by))


@figure_command("Delete keys of track")
def delete_track_keys(figure: Figure, handle: int, frames: Collection[int]) -> Figure:
    """Delete the keys of a track at some frames; with the last one the track goes."""
    track = _track(figure, handle)
    keys = keys_in_time.without(track.keys, frames)
    if not keys:
        return _with_tracks(figure, (each for each in figure.tracks if each is not track))
    return _with_keys(figure, track, keys)


@figure_command("Reverse keys of track")
def reverse_track_keys(
    figure: Figure, handle: int, frames: Collection[int], span: tuple[int, int] | None = None
) -> Figure:
    """Let a track run backwards between some of its keys, or in a span of frames."""
    track = _track(figure, handle)
    return _with_keys(figure, track, keys_in_time.backwards(track.keys, frames, span))


@figure_command("Scale time of keys of track")
def scale_track_keys(
    figure: Figure, handle: int, frames: Collection[int], factor: float, first: int | None = None
) -> Figure:
    """Move keys of a track apart or together in time, around the first of them or a frame."""
    track = _track(figure, handle)
    return _with_keys(figure, track, keys_in_time.spread(track.keys, frames, factor, first))


@figure_command("Set easing")
def set_track_easing(
    figure: Figure, handle: int, frames: Collection[int], easing: Easing
) -> Figure:
    """Set how time runs from the keys of a track at some frames to the next ones.

    They are passed at no velocity of their own any more.
    """
    track = _track(figure, handle)
    return _with_keys(figure, track, keys_in_time.eased(_unled(track, frames), frames, easing))


@figure_command("Set passing")
def set_track_passing(
    figure: Figure, handle: int, frames: Collection[int], passing: Passing
) -> Figure:
    """Set how a track passes its keys at some frames; one that held its place does no longer.

    None of them has a velocity of its own any more.
    """
    track = _track(figure, handle)
    return _with_keys(figure, track, keys_in_time.passed(_unled(track, frames), frames, passing))


@figure_command("Set delay")
def set_delay(figure: Figure, handle: int, delay: int) -> Figure:
    """Set by how many frames a track is late."""
    return _with(figure, handle, delay=delay)


@figure_command("Set reach")
def set_reach(figure: Figure, handle: int, reach: float) -> Figure:
    """Set how far around a track's handles the body gives, from 0 to 1."""
    return _with(figure, handle, reach=float(reach))


@figure_command("Set turning")
def set_turning(figure: Figure, handle: int, *, turns: bool) -> Figure:
    """Let a track turn the shape at its handles, or leave that free."""
    return _with(figure, handle, turns=turns)


@figure_command("Switch track on or off")
def enable_track(figure: Figure, handle: int, *, enabled: bool) -> Figure:
    """Let a track act, or not; its keys stay."""
    return _with(figure, handle, enabled=enabled)


@figure_command("Plant track")
def plant_track(
    figure: Figure,
    handle: int,
    places: Sequence[complex],
    velocities: Sequence[complex | None] | None = None,
    *,
    planted: bool,
) -> Figure:
    """Let a track's keys be places in the picture, or beside the pose.

    Parameters
    ----------
    places, velocities : sequences of complex
        What the keys have then, in their order; `app.motion` knows it. Without velocities they have
        none of their own any more.
    """
    track = _track(figure, handle)
    velocities = velocities or [None] * len(places)
    if not len(places) == len(velocities) == len(track.keys):
        raise LissomError(f"The track has {len(track.keys)} keys, not {len(places)}.")
    keys = tuple(
        replace(key, place=place, velocity=velocity)
        for key, place, velocity in zip(track.keys, places, velocities, strict=True)
    )
    return _with(figure, handle, planted=planted, keys=keys)


@figure_command("Set handles of track")
def set_track_handles(figure: Figure, handle: int, handles: Sequence[int]) -> Figure:
    """Set which handles a track moves, the first of which its keys are of."""
    track = _track(figure, handle)
    return _with_track(figure, moved_to(figure, track, tuple(handles)), instead=track)


@figure_command("Copy track")
def copy_track(figure: Figure, handle: int, to: int) -> Figure:
    """Give another handle the track of a handle, so that it is moved alike from where it is."""
    return _with_track(figure, moved_to(figure, _track(figure, handle), (to,)))


@figure_command("Copy track mirrored")
def mirror_track(figure: Figure, handle: int, pairs: SidePairs = PAIRS) -> Figure:
    """Give the handles on the other side the track of a handle, mirrored.

    A handle without a partner keeps its track, and does its mirror image.
    """
    return _with_track(figure, mirrored_track(figure, _track(figure, handle), pairs))


@figure_command("Set spring")
def put_spring(figure: Figure, spring: Spring) -> Figure:
    """Let a handle follow by a spring, in place of the one that it has."""
    if figure.spring_of(spring.handle) == spring:
        return figure
    others = tuple(each for each in figure.springs if each.handle != spring.handle)
    return replace(figure, springs=(*others, spring))


@figure_command("Delete spring")
def remove_springs(figure: Figure, handles: Collection[int]) -> Figure:
    """Let handles follow no longer."""
    springs = tuple(spring for spring in figure.springs if spring.handle not in handles)
    return figure if springs == figure.springs else replace(figure, springs=springs)


def _track(figure: Figure, handle: int) -> Track:
    track = figure.track_of(handle)
    if track is None:
        raise LissomError(f"The handle {figure.handle(handle).name!r} has no track.")
    return track


def _unled(track: Track, frames: Collection[int]) -> tuple[TrackKey, ...]:
    """Return the keys of a track, those at some frames without a velocity of their own."""
    chosen = keys_in_time.at_frames(track.keys, frames)
    return keys_in_time.exchanged(track.keys, {key.frame: key.unled() for key in chosen})


def _with_track(figure: Figure, track: Track, *, instead: Track | None = None) -> Figure:
    """Return the figure with a track, in place of another one; its handles leave theirs."""
    for handle in track.handles:
        figure.handle(handle)
    same = (each for each in figure.tracks if each.handles == track.handles)
    instead = instead or next(same, None)
    tracks = [
        track if each is instead else left(figure, each, track.handles) for each in figure.tracks
    ]
    return _with_tracks(figure, filter(None, tracks if instead else [*tracks, track]))


def _with_tracks(figure: Figure, tracks: Iterable[Track]) -> Figure:
    """Return the figure with these tracks, itself if it has them."""
    given = tuple(tracks)
    return figure if given == figure.tracks else replace(figure, tracks=given)


def _with_keys(figure: Figure, track: Track, keys: tuple[TrackKey, ...]) -> Figure:
    return _with_track(figure, replace(track, keys=keys), instead=track)


def _with(figure: Figure, handle: int, **changes: Any) -> Figure:
    track = _track(figure, handle)
    return _with_track(figure, replace(track, **changes), instead=track)
