"""Actions on tracks: selecting their rows, and keys of single handles."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from app.document import (
    Channel,
    Command,
    Document,
    Layer,
    Track,
    TrackKey,
    track_at,
    track_commands,
    track_display_frame,
    velocity_at,
)
from app.editor import pending_changes
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import UNLESS_HANDLES, named_action
from app.editor.actions.posing.pose_solver import finish_drag
from app.editor.actions.tracking.track_space import find_key_frame
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.motion import PoseSampler, find_parent_motion, layer_animation
from app.texts import _
from engine.geometry import IDENTITY_MOTION, Similarity

AROUND = 1 / 64  # frames before and after a key, between which its velocity is measured
CONVERTING_KEYS = JobKind(_("Moving keys of a track"), _("The track's keys could not be placed"))


@with_project
def select_channel(_: Session, project: Project, channel: Channel[Any] | None) -> None:
    """Select a channel, by default the poses; drags then key it if it is a track."""
    project.selection.select_channel(channel)


@named_action(
    _("Key this handle only"),
    "Shift+I",
    icon="KEY",
    hint=_("Key only this handle at this frame, on a track of its own"),
    why_disabled=UNLESS_HANDLES,
)
@with_project
def key_selected_handles(session: Session, project: Project) -> None:
    """Key the selected handles at the present frame, not the pose."""
    key_handles_at_playhead(session, sorted(project.selection.handles))


@with_project
def key_handles_at_playhead(session: Session, project: Project, handles: Sequence[int]) -> None:
    """Key handles at the present frame where they are, and select their track's row.

    Handles without a track get a shared track relative to the pose; its first key has offset 0.
    """
    playback.stop_playback(session)
    finish_drag(session, project)
    layer, gesture = project.layer, object()
    new = tuple(identity for identity in handles if layer.track_of(identity) is None)
    if new:
        frame = playback.edited_frame(session, project)
        key = TrackKey(frame=frame, place=0j, easing=session.settings.preferences.easing)
        command = track_commands.put_track(
            project.selection.active, Track(handles=new, keys=(key,))
        )
        project.history.do(Command(_("Key handle"), command.change), gesture=gesture)
    known = {layer.track_of(identity) for identity in handles} - {None}
    for track in known:
        if track is not None:
            _key(session, project, track, gesture)
    project.selection.select_track(project.layer, (new or tuple(handles))[0])
    project.timeline.show_lanes(project.selection.active)


def _key(session: Session, project: Project, track: Track, gesture: object) -> None:
    """Insert a key into a track at the present frame without moving the handle."""
    frame, layer = playback.current_frame(session, project), project.layer
    own = find_key_frame(session, project.document, track, frame)
    if own is None or own in track.key_frames:
        return
    easing, clip = session.settings.preferences.easing, project.clip

    def put(place: complex, turn: float | None = None) -> None:
        command = track_commands.put_track_key(
            layer.id,
            track.handles[0],
            own,
            place,
            turn=turn,
            velocity=velocity_at(track, clip, frame),
            easing=easing,
        )
        if layer.id in project.runtimes.layers and project.document.layer(layer.id).tracks:
            project.history.do(command, gesture=gesture)

    at = track_at(track, clip, frame)
    if at is not None:
        put(at.place, at.turn if track.keys_rotation else None)
    elif not track.is_scene_space:
        put(0j)
    else:
        place = partial(_base_value_at, project.document, layer, track, [frame], project.samplers)
        pending_changes.begin_pending_change(
            session, project, CONVERTING_KEYS, place, lambda found: put(found[0].planted(0j))
        )


@with_project
def set_handle_value(
    session: Session, project: Project, handle: int, place: complex, turn: float | None = None
) -> None:
    """Key the track of a handle at the present frame with a place.

    A track relative to the pose stores an offset from the pose. It may begin and end at offset 0.
    """
    playback.stop_playback(session)
    track = project.layer.track_of(handle)
    if track is None:
        return
    frame = playback.current_frame(session, project)
    own = find_key_frame(session, project.document, track, frame)
    if own is not None:
        key, easing = track_commands.put_track_key, session.settings.preferences.easing
        velocity = velocity_at(track, project.clip, frame)
        editing.edit_layer(
            session, key, handle, own, place, turn=turn, velocity=velocity, easing=easing
        )


class _BaseValue(NamedTuple):
    """A handle's motion at a frame without its track; track keys are relative to it."""

    place: complex  # in the layer's own space
    turned: complex  # of modulus 1: rotation of the shape at the handle
    carried: Similarity  # motion of the layer by its parents

    def planted(self, offset: complex) -> complex:
        """Convert an offset from the pose to a place in the scene."""
        place = np.array([self.place + offset * self.turned])
        return complex(self.carried.apply(place)[0])

    def offset(self, planted: complex) -> complex:
        """Convert a place in the scene to an offset from the pose."""
        return (self.carried.apply_inverse(planted) - self.place) * self.turned.conjugate()


def _base_value_at(
    document: Document,
    layer: Layer,
    track: Track,
    frames: Sequence[float],
    siblings: Mapping[int, PoseSampler],
) -> list[_BaseValue]:
    """Return the base motion of a track's first handle at some frames."""
    point = np.array([layer.handle(track.handles[0]).position])
    carried = find_parent_motion(document, layer.id, siblings)
    animation = layer_animation(document, layer.id, point, siblings, carried)
    found = []
    for frame in frames:
        still = animation.base.frame(frame)
        fz = complex(still.fz[0])
        parent_motion = IDENTITY_MOTION if carried is None else carried(frame)
        found.append(_BaseValue(complex(still.positions[0]), fz / abs(fz), parent_motion))
    return found


@with_project
def set_track_space(session: Session, project: Project, handle: int, planted: bool) -> None:  # noqa: FBT001
    """Convert a track's keys to places in the scene or to offsets; the motion stays."""
    layer, track = project.layer, project.layer.track_of(handle)
    if track is None or track.is_scene_space == planted:
        return
    around = [_frames_around(project.document, track, key) for key in track.keys]
    frames = [frame for each in around for frame in each]
    work = partial(_base_value_at, project.document, layer, track, frames, project.samplers)

    def take(found: list[_BaseValue]) -> None:
        now = {each.id: each for each in project.document.layers}.get(layer.id)
        if now is None or track not in now.tracks:
            # The track has changed meanwhile.
            return
        beside = dict(zip(frames, found, strict=True))
        keys = [
            _replaced(key, [beside[frame] for frame in each], each, planted=planted)
            for key, each in zip(track.keys, around, strict=True)
        ]
        places, velocities = [key.place for key in keys], [key.velocity for key in keys]
        command = track_commands.plant_track
        project.history.do(command(layer.id, handle, places, velocities, planted=planted))

    pending_changes.begin_pending_change(session, project, CONVERTING_KEYS, work, take)


def _frames_around(document: Document, track: Track, key: TrackKey) -> list[float]:
    """Return the scene frame of a key, and two nearby frames that give its velocity.

    Without a velocity of its own, the key needs no nearby frames.
    """
    seen, frames = track_display_frame(document, track, key.frame), document.frames
    if key.velocity is None:
        return [seen]
    return [seen, max(seen - AROUND, frames.first), min(seen + AROUND, frames.last)]


def _replaced(
    key: TrackKey, beside: Sequence[_BaseValue], frames: Sequence[float], *, planted: bool
) -> TrackKey:
    """Convert a key to a place in the scene or to an offset, without moving the handle."""
    there = []
    for frame, each in zip(frames, beside, strict=True):
        place = key.place + (frame - frames[0]) * (key.velocity or 0j)
        there.append(each.planted(place) if planted else each.offset(place))
    if key.velocity is None:
        return replace(key, place=there[0])
    here, before, after = there
    return replace(key, place=here, velocity=(after - before) / (frames[2] - frames[1]))
