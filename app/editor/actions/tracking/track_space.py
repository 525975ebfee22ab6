"""What tracks' keys are on the layer that is posed: places, and back."""

import cmath
import math

from app.document import Document, Track, track_at
from app.editor.project import Project
from app.editor.session import Session
from app.editor.timeline_view import source_frame
from app.motion import BaseMotionFrame


def find_key_frame(session: Session, document: Document, track: Track, frame: int) -> int | None:
    """Return the frame of the key that is seen at a frame; where there can be none, it is told."""
    own = source_frame(document, track, frame)
    if own is None:
        session.show_notice(
            f"The track is {track.delay} frames late: no key of it can be seen at frame {frame}.",
            topic="late",
        )
    return own


def base_frame_at(project: Project, frame: int) -> BaseMotionFrame | None:
    """Return what tracks are relative to at a frame, if it is known yet."""
    corrected = project.layer_runtime.corrected
    return None if corrected is None else corrected.ground(frame)


def handle_index(project: Project, handle: int) -> int:
    """Return which of the layer's handles it is."""
    return [each.id for each in project.layer.handles].index(handle)


def track_target(project: Project, track: Track, frame: int) -> complex | None:
    """Return where a track wants its first handle at a frame, on the layer by itself.

    None where it does not act, or where that is not known yet.
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
    """Return by how much a handle's track wants the shape turned there, in radians.

    None where it turns nothing, or where that is not known yet.
    """
    track, ground = project.layer.track_of(handle), base_frame_at(project, frame)
    at = None if track is None or not track.keys_rotation else track_at(track, project.clip, frame)
    if at is None or ground is None:
        return None
    return at.turn + cmath.phase(ground.rotations[handle_index(project, handle)])


def to_track_angle(project: Project, handle: int, frame: int, turn: float) -> float | None:
    """Return what a key of a handle's track has there for a turn of the shape, in radians.

    Of all that are whole turns apart it is the nearest to what the track has there. None where it
    is not known yet.
    """
    track, ground = project.layer.track_of(handle), base_frame_at(project, frame)
    if ground is None:
        return None
    at = None if track is None else track_at(track, project.clip, frame)
    near = 0.0 if at is None else at.turn
    beside = turn - cmath.phase(ground.rotations[handle_index(project, handle)])
    return beside + math.tau * round((near - beside) / math.tau)


def to_track_offset(project: Project, handle: int, frame: int, place: complex) -> complex | None:
    """Return what a key of a handle's track has there for a place of the layer by itself.

    A handle without a track gets one with the pose. None where it is not known yet.
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
