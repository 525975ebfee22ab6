"""The pointer in the viewport, from press to release: the tool that takes the press has it."""

from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.tools.table import tools_of
from app.editor.tools.tool import Spot


@with_project
def press(session: Session, project: Project, spot: Spot) -> None:
    """Give a press to the first tool that takes it."""
    if project.puppet.shown is not None:
        gestures = (tool.press(session, project, spot) for tool in tools_of(session))
        session.pointer = next((gesture for gesture in gestures if gesture is not None), None)


def move(session: Session, place: complex) -> None:
    """Follow the pointer to another place of the plane."""
    _move(session, place, snaps=False)


def move_in_steps(session: Session, place: complex) -> None:
    """Follow the pointer; what is turned turns by round angles."""
    _move(session, place, snaps=True)


def _move(session: Session, place: complex, *, snaps: bool) -> None:
    if session.pointer:
        session.snaps = snaps
        session.pointer.move(session, place)


def type_in(session: Session, characters: str) -> None:
    """Give what is typed during a drag to the tool in hand."""
    if session.pointer:
        session.pointer.type(session, characters)


def end(session: Session, place: complex) -> None:
    """End what the pointer does where it is."""
    _end(session, place, insists=False)


def end_insisting(session: Session, place: complex) -> None:
    """End what the pointer does where it is; what it pulls is wanted there, however far that is."""
    _end(session, place, insists=True)


def _end(session: Session, place: complex, *, insists: bool) -> None:
    gesture, session.pointer = session.pointer, None
    if gesture:
        session.insists = insists
        gesture.end(session, place)


def cancel(session: Session) -> None:
    """End what the pointer does, and take it back."""
    gesture, session.pointer = session.pointer, None
    if gesture:
        gesture.cancel(session)


def hover(session: Session, handle: int | None) -> None:
    """Note which handle is under the pointer."""
    session.hovered = handle


def explain(session: Session, hint: str) -> None:
    """Show a hint in the status bar."""
    session.hint = hint


def use_space(session: Session) -> None:
    """Note that Space was held to move the view, so that letting it go does not play."""
    session.space_used = True
