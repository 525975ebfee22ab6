"""Changes of the document: commands, undo, and what is selected."""

from collections.abc import Callable
from dataclasses import replace
from typing import Concatenate, ParamSpec

from app.document import Command, key_commands
from app.editor.actions import posing
from app.editor.session import Project, Session

Arguments = ParamSpec("Arguments")


def edit(session: Session, command: Command) -> None:
    """Run a command; those given while the pointer holds on make one step of undo together."""
    project = session.project
    if project is None:
        return
    before = _posed(project)
    project.history.do(command, gesture=project.gesture)
    if _posed(project) != before:
        # The solver would put back what the command took away.
        posing.drop(session)
    _forget_what_is_gone(project)


def edit_figure(
    session: Session,
    command: Callable[Concatenate[int, Arguments], Command],
    *args: Arguments.args,
    **kwargs: Arguments.kwargs,
) -> None:
    """Run a command on the figure that is posed."""
    if session.project:
        edit(session, command(session.project.active, *args, **kwargs))


def hold(session: Session, held: int) -> None:
    """Note what the pointer or the keyboard holds on to; called once a frame.

    Parameters
    ----------
    session : Session
    held : int
        A number of the widget, 0 for nothing; another one begins another step of undo.
    """
    project = session.project
    if project and held != project.held:
        project.held = held
        project.gesture = object() if held else None


def undo(session: Session) -> None:
    """Take the last step back: a pose that no key holds, or what the document had last."""
    project = session.project
    if project is None:
        return
    grab = project.grab or project.settling
    is_unkept = project.unkeyed is not None or (grab is not None and grab.drag is None)
    posing.drop(session)
    project.unkeyed = None
    if not is_unkept:
        project.history.undo()
        _forget_what_is_gone(project)


def redo(session: Session) -> None:
    """Do the step that was taken back again."""
    if session.project:
        posing.drop(session)
        session.project.history.redo()
        session.project.unkeyed = None
        _forget_what_is_gone(session.project)


def select(session: Session, handles: frozenset[int]) -> None:
    """Select these handles, as far as they are there, and no keys."""
    project = session.project
    if project:
        project.selected, project.chosen = handles, frozenset()
        _forget_what_is_gone(project)


def select_all(session: Session) -> None:
    """Select every handle."""
    if session.project:
        select(session, frozenset(handle.id for handle in session.project.figure.handles))


def choose_keys(session: Session, frames: frozenset[int]) -> None:
    """Select the keys at these frames, as far as they are there, and no handles."""
    project = session.project
    if project:
        project.selected, project.chosen = frozenset(), frames
        _forget_what_is_gone(project)


def delete(session: Session) -> None:
    """Delete the selected keys, or the selected handles."""
    project = session.project
    if project and project.chosen:
        edit_figure(session, key_commands.delete_keys, project.chosen)
    elif project and project.selected:
        posing.remove_handles(session, project.selected)


def _posed(project: Project) -> tuple[object, ...]:
    """Return the pose that handles are being pulled in, and what it is solved from."""
    figure, grab = project.figure, project.grab or project.settling
    poses = [key.pose for key in figure.keys if grab is not None and key.frame == grab.frame]
    return (poses, figure.handles, figure.bounds, figure.domain)


def _forget_what_is_gone(project: Project) -> None:
    document = project.document
    project.selected &= {handle.id for handle in project.figure.handles}
    project.chosen &= project.figure.key_frames
    if project.playhead.frame not in document.frames:
        frame = document.frames.clamp(project.playhead.frame)
        project.playhead = replace(project.playhead, frame=frame)
