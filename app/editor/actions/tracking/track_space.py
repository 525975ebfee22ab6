"""Conversion between places of the active layer and values of track keys."""

import cmath
import math

from app.document import (
    Document,
    Track,
    track_at,
    track_source_frame,
)
from app.editor.project import Project
from app.editor.session import Session
from app.motion import BaseMotionFrame
from app.texts import ngettext


def find_key_frame(session: Session, document: Document, track: Track, frame: int) -> int | None:
    """Return the frame of the track key for a frame; show a notice if none is possible."""
    own = track_source_frame(document, track, frame)
    if own is None:
        session.notices.show(
            ngettext(
                "The track is delayed by {delay} frame, so none of its keys can act at frame "
                "{frame}.",
                "The track is delayed by {delay} frames, so none of its keys can act at frame "
                "{frame}.",
                track.delay,
            ).format(delay=track.delay, frame=frame),
            topic="late",
        )
    return own


def base_frame_at(project: Project, frame: int) -> BaseMotionFrame | None:
    """Return the base motion of tracks at a frame; None while it is unknown."""
    corrected = project.layer_runtime.corrected
    return None if corrected is None else corrected.ground(frame)


def handle_index(project: Project, handle: int) -> int:
    return [each.id for each in project.layer.handles].index(handle)


def track_target(project: Project, track: Track, frame: int) -> complex | None:
    """Return a track's target of its first handle at a frame, in the layer's own space.

    None if the track has no value there, or while its base motion is unknown.
    """
    at, ground = track_at(track, project.clip, frame), base_frame_at(project, frame)
    shown = project.layer_runtime.shown
    if at is None or shown is None:
        return None
    if track.is_scene_space:
        return project.placements([frame], shown.placement)[0].apply_inverse(at.place)
    if ground is None:
        return None
    index = handle_index(project, track.handles[0])
    return complex(ground.positions[index] + at.place * ground.rotations[index])


def track_target_angle(project: Project, handle: int, frame: int) -> float | None:
    """Return a track's target rotation of the shape at a handle, in radians.

    None if the track keys no rotation, or while its base motion is unknown.
    """
    track, ground = project.layer.track_of(handle), base_frame_at(project, frame)
    at = None if track is None or not track.keys_rotation else track_at(track, project.clip, frame)
    if at is None or ground is None:
        return None
    return at.turn + cmath.phase(ground.rotations[handle_index(project, handle)])


def to_track_angle(project: Project, handle: int, frame: int, turn: float) -> float | None:
    """Convert a rotation of the shape to the value of a track key, in radians.

    Among values whole turns apart, it is the nearest to the track's present value. None while the
    base motion is unknown.
    """
    track, ground = project.layer.track_of(handle), base_frame_at(project, frame)
    if ground is None:
        return None
    at = None if track is None else track_at(track, project.clip, frame)
    near = 0.0 if at is None else at.turn
    beside = turn - cmath.phase(ground.rotations[handle_index(project, handle)])
    return beside + math.tau * round((near - beside) / math.tau)


def to_track_offset(project: Project, handle: int, frame: int, place: complex) -> complex | None:
    """Convert a place in the layer's own space to the value of a track key.

    A new track is relative to the pose. None while the base motion is unknown.
    """
    track, shown = project.layer.track_of(handle), project.layer_runtime.shown
    if track is not None and track.is_scene_space:
        if shown is None:
            return None
        (placement,) = project.placements([frame], shown.placement)
        return placement.factor * place + placement.shift
    ground = base_frame_at(project, frame)
    if ground is None:
        return None
    index = handle_index(project, handle)
    return complex((place - ground.positions[index]) * ground.rotations[index].conjugate())
