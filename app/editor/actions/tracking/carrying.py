"""Handles that a hand carries: each place of the pointer is a key of the handle's track.

The document has the key at once. What is shown follows as fast as corrections are solved, those of
the newest place.
"""

from app.document import Track, track_at, track_commands, velocity_at
from app.editor.actions import playback
from app.editor.actions.tracking.places import kept, key_frame
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work import Carry


def carried_track(project: Project, handle: int) -> Track | None:
    """Return the track that a drag of a handle is for, as its row is chosen; None for poses."""
    chosen = project.chosen_track
    track = None if chosen is None else project.figure.track_of(chosen)
    return track if track is not None and handle in track.handles else None


@with_project
def carry(
    session: Session, project: Project, handle: int, place: complex, *, gesture: object
) -> None:
    """Want a handle elsewhere at the present frame by its own track; the pose stays.

    What one gesture does is one step of undo.

    Parameters
    ----------
    handle : int
        The first one of the track's.
    place : complex
        On the figure by itself.
    """
    for held in project.carries:
        if held.gesture is gesture:
            held.place = place
            return
    playback.halt(session)
    frame = playback.current_frame(session, project)
    begun = Carry(figure=project.active, handle=handle, frame=frame, gesture=gesture, place=place)
    project.pending.append(begun)


def go_on(session: Session, project: Project) -> None:
    """Let tracks have the keys that hands want, as far as these are known; once a frame."""
    for held in project.carries:
        is_there = held.figure == project.active and held.handle in [
            handle.id for handle in project.figure.handles
        ]
        if not is_there or put_key(
            session, project, held.handle, held.frame, held.place, held.gesture
        ):
            project.pending.remove(held)


def put_key(
    session: Session,
    project: Project,
    handle: int,
    frame: int,
    place: complex,
    gesture: object,
) -> bool:
    """Give a handle's track a key at a frame of the scene; tell whether nothing is awaited."""
    figure, clip = project.figure, project.clip
    track = figure.track_of(handle)
    own = frame if track is None else key_frame(session, project.document, track, frame)
    if own is None:
        return True
    value = kept(project, handle, frame, place)
    if value is None:
        return False
    turn = velocity = None
    if track is not None and own not in track.key_frames:
        at, velocity = track_at(track, clip, frame), velocity_at(track, clip, frame)
        turn = None if at is None else at.turn
    easing = session.preferences.easing
    command = track_commands.put_track_key(
        figure.id, handle, own, value, turn=turn, velocity=velocity, easing=easing
    )
    project.history.do(command, gesture=gesture)
    return True
