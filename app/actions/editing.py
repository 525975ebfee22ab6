"""Changes of the document: commands, undo, and what is selected."""

from app.actions import posing
from app.document import key_commands
from app.document.commands import Command
from app.session import Session


def edit(session: Session, command: Command) -> None:
    """Run a command; those given while the pointer holds on make one step of undo together."""
    if session.project:
        session.project.history.do(command, gesture=session.project.gesture)


def hold(session: Session, held: bool) -> None:  # noqa: FBT001 - the only argument
    """Note whether the pointer holds on to something; called once a frame."""
    project = session.project
    if project and held != (project.gesture is not None):
        project.gesture = object() if held else None


def undo(session: Session) -> None:
    """Take the last step back."""
    if session.project:
        posing.drop(session)
        session.project.history.undo()
        _forget_what_is_gone(session)


def redo(session: Session) -> None:
    """Do the step that was taken back again."""
    if session.project:
        posing.drop(session)
        session.project.history.redo()
        _forget_what_is_gone(session)


def select(session: Session, handles: frozenset[int]) -> None:
    """Select these handles and no keys."""
    if session.project:
        session.project.selected = handles
        session.project.chosen = frozenset()


def select_all(session: Session) -> None:
    """Select every handle."""
    if session.project:
        select(session, frozenset(handle.id for handle in session.project.document.handles))


def choose_keys(session: Session, frames: frozenset[int]) -> None:
    """Select the keys at these frames and no handles."""
    if session.project:
        session.project.chosen = frames
        session.project.selected = frozenset()


def delete(session: Session) -> None:
    """Delete the selected keys, or the selected handles."""
    project = session.project
    if project and project.chosen:
        edit(session, key_commands.delete_keys(project.chosen))
    elif project and project.selected:
        posing.remove_handles(session, project.selected)
    _forget_what_is_gone(session)


def _forget_what_is_gone(session: Session) -> None:
    project = session.project
    if project:
        project.loose = None
        project.selected &= {handle.id for handle in project.document.handles}
        project.chosen &= {key.frame for key in project.document.keys}
