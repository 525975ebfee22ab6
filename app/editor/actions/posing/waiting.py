"""What is asked of a pose before it is shown: it is done as soon as that is there.

Until an in-between is prepared, another pose stands in for it. What the hand does meanwhile is
meant for the one that belongs there, and is not lost.
"""

from collections.abc import Callable
from dataclasses import replace

from app.editor.actions import playback
from app.editor.project import Awaiting, Project
from app.editor.session import Session


def is_there(session: Session, project: Project) -> bool:
    """Tell whether what should be shown is, or never will be."""
    shown = project.puppet.shown
    if project.unkeyed is not None or project.puppet.store.has_failed(project.clip):
        return True
    if shown is None or not shown.is_current:
        return False
    # While it plays, what is shown is always that of a moment ago.
    is_playing = project.playhead.since is not None
    return is_playing or shown.frame == playback.current_frame(session, project)


def waits(
    session: Session, verb: Callable[[Session], None], *, gesture: object | None = None
) -> bool:
    """Put off what needs the pose that belongs to the present frame until it is shown.

    Parameters
    ----------
    session : Session
    verb : callable
        What is then to be done.
    gesture : object, optional
        What else of it was put off just before, this takes the place of.

    Returns
    -------
    bool
        Whether it was put off, and not to be done now.
    """
    project = session.project
    if project is None or (project.posing is not None and project.posing.is_held):
        return False
    if project.awaiting is None and is_there(session, project):
        return False
    playback.halt(session)
    frame = playback.current_frame(session, project)
    earlier = () if project.awaiting is None else project.awaiting.verbs
    if gesture is not None and earlier and earlier[-1][0] is gesture:
        earlier = earlier[:-1]
    verbs = (*earlier, (gesture, verb))
    project.awaiting = Awaiting(figure=project.active, frame=frame, verbs=verbs)
    return True


def forget(project: Project, gesture: object) -> None:
    """Take back what a gesture has asked for."""
    if project.awaiting is not None:
        kept = tuple(each for each in project.awaiting.verbs if each[0] is not gesture)
        project.awaiting = replace(project.awaiting, verbs=kept) if kept else None


def catch_up(session: Session, project: Project) -> None:
    """Do what was put off if the pose that it is for is there; once a frame."""
    awaiting = project.awaiting
    if awaiting is None:
        return
    frame = playback.current_frame(session, project)
    if (awaiting.figure, awaiting.frame) != (project.active, frame):
        give_up(session, project)
    elif is_there(session, project):
        project.awaiting = None
        for _, verb in awaiting.verbs:
            verb(session)


def give_up(session: Session, project: Project) -> None:
    """Let what was put off be, and say so."""
    if project.awaiting is not None:
        session.tell(
            f"The in-between of frame {project.awaiting.frame} was not there yet: the handles were "
            "not pulled."
        )
        project.awaiting = None
