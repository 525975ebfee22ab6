"""Drags of handles along their tracks: each pointer place becomes a key of the track.

The document has the key at once. The shown frame follows as fast as the worker solves the
correction for the newest place.
"""

from app.document import Track, track_at, track_commands, velocity_at
from app.editor.actions import playback
from app.editor.actions.tracking.track_space import (
    find_key_frame,
    handle_index,
    to_track_angle,
    to_track_offset,
)
from app.editor.error_reports import report_failure
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.track_keys import PendingTrackKey, TrackTarget
from app.errors import LissomError
from app.texts import _

NO_KEY = _("The handle could not be keyed")


def draggable_track(project: Project, handle: int) -> Track | None:
    """Return the track that a drag of a handle keys; None if the drag keys the pose."""
    chosen = project.selected_track
    track = None if chosen is None else project.layer.track_of(chosen)
    return track if track is not None and handle in track.handles else None


@with_project
def drag_track_handle(
    session: Session, project: Project, handle: int, place: complex, *, gesture: object
) -> None:
    """Set a handle's target at the present frame on its own track; the pose stays.

    Edits of one gesture are one undo step. `handle` is the first handle of the track. `place` is in
    the layer's own space.
    """
    if not project.history.hold(gesture):
        return
    playback.stop_playback(session)
    frame = playback.current_frame(session, project)
    target = TrackTarget(layer=project.selection.active, handle=handle, frame=frame, place=place)
    _preview_target(session, project, target, gesture)


@with_project
def rotate_track_handle(
    session: Session, project: Project, handle: int, angle: float, *, gesture: object
) -> None:
    """Set the rotation of the shape at a handle, in radians, on the handle's track.

    A track that keyed no rotation keys it from now on; its other keys get the pose's rotation.
    """
    track, shown = project.layer.track_of(handle), project.layer_runtime.shown
    if track is None or shown is None or not project.history.hold(gesture):
        return
    if not track.keys_rotation:
        command = track_commands.set_turning(project.selection.active, handle, turns=True)
        project.history.do(command, gesture=gesture)
        text = _("The keys of this track now turn the shape, too.")
        session.notices.show(text, topic="turning")
    playback.stop_playback(session)
    frame, place = playback.current_frame(session, project), shown.handle_positions
    target = TrackTarget(
        layer=project.selection.active,
        handle=handle,
        frame=frame,
        place=complex(place[handle_index(project, handle)]),
        turn=angle,
    )
    _preview_target(session, project, target, gesture)


def _preview_target(
    session: Session, project: Project, target: TrackTarget, gesture: object
) -> None:
    """Key a target on its track, or as soon as the track's base motion is known."""
    for pending in project.pending_track_keys:
        if pending.gesture is gesture:
            project.pending.remove(pending)
    if not key_track_target(session, project, target, gesture):
        project.pending.add(PendingTrackKey(target=target, gesture=gesture))


def key_pending_targets(session: Session, project: Project) -> None:
    """Key the pending targets of tracks whose base motion is known by now; once a frame."""
    for pending in project.pending_track_keys:
        target = pending.target
        is_there = (
            project.history.is_open(pending.gesture)
            and target.layer == project.selection.active
            and target.handle in [handle.id for handle in project.layer.handles]
        )
        try:
            is_over = not is_there or key_track_target(session, project, target, pending.gesture)
        except LissomError as error:
            report_failure(session, NO_KEY, error)
            is_over = True
        if is_over:
            project.pending.remove(pending)


def key_track_target(
    session: Session, project: Project, target: TrackTarget, gesture: object
) -> bool:
    """Key a target on its track; return False while the track's base motion is unknown."""
    handle, frame = target.handle, target.frame
    track = project.layer.track_of(handle)
    own = frame if track is None else find_key_frame(session, project.document, track, frame)
    if own is None:
        return True
    at = None if track is None else track_at(track, project.clip, frame)
    velocity = None if track is None else velocity_at(track, project.clip, frame)
    if target.turn is None:
        place = to_track_offset(project, handle, frame, target.place)
        is_new = track is not None and own not in track.key_frames
        turn = at.turn if at is not None and is_new else None
    else:
        place = to_track_offset(project, handle, frame, target.place) if at is None else at.place
        turn = to_track_angle(project, handle, frame, target.turn)
        if turn is None:
            return False
    if place is None:
        return False
    command = track_commands.put_track_key(
        target.layer,
        handle,
        own,
        place,
        turn=turn,
        velocity=velocity,
        easing=session.settings.preferences.easing,
    )
    project.history.do(command, gesture=gesture)
    return True
