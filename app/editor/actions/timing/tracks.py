"""What is done with tracks: choosing their rows, and keys of single handles."""

from app.document import Clip, Track, track_at, track_commands
from app.editor.actions import editing, playback, posing
from app.editor.project import Project
from app.editor.session import Session, with_project


@with_project
def choose(_: Session, project: Project, handle: int | None) -> None:
    """Choose the row of a handle's track, so that drags of it go there; None the whole pose's."""
    project.chosen_track = handle


@with_project
def key_here(session: Session, project: Project, handle: int) -> None:
    """Key a handle alone at the present frame, where it is now, and choose its track's row.

    With the pose that is no offset, where no track of it acts yet.
    """
    playback.halt(session)
    posing.let_go(session)
    frame, figure, shown = playback.current_frame(session, project), project.figure, project.puppet
    track, clip = figure.track_of(handle), project.clip
    own = frame if track is None else own_frame(track, clip, frame)
    if own is None or shown.shown is None:
        session.tell(
            f"Frame {frame} comes before the delay of {figure.handle(handle).name}'s track is over."
        )
        return
    at, turn = None if track is None else track_at(track, clip, frame), None
    place = 0j
    if at is not None:
        place, turn = at
    elif track is not None and track.planted:
        index = [each.id for each in figure.handles].index(handle)
        place = complex(shown.shown.placement.on(shown.shown.handle_places)[index])
    easing = session.preferences.easing
    key = track_commands.put_track_key(project.active, handle, own, place, turn=turn, easing=easing)
    editing.edit(session, key)
    project.chosen_track = handle


def own_frame(track: Track, clip: Clip, frame: int) -> int | None:
    """Return the frame at which a key of a track is seen at a frame of the scene, for its delay.

    In a loop it comes round; else there may be none.
    """
    own = frame - track.delay
    if own < clip.frames.first and clip.loop:
        own += clip.period
    return None if own < clip.frames.first else own
