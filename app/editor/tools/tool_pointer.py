"""The pointer in the viewport, from press to release: the tool that takes the press has it."""

from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.tools.table import tools_of
from app.editor.tools.tool import PointerHit


@with_project
def press_pointer(session: Session, project: Project, spot: PointerHit) -> None:
    """Give a press to the first tool that takes it."""
    if project.layer_runtime.shown is not None:
        gestures = (tool.press(session, project, spot) for tool in tools_of(session))
        session.active_tool = next((gesture for gesture in gestures if gesture is not None), None)


def move_pointer(session: Session, place: complex) -> None:
    """Follow the pointer to another place of the plane."""
    _move_pointer(session, place, snaps=False)


def move_pointer_in_steps(session: Session, place: complex) -> None:
    """Follow the pointer; what is turned turns by round angles."""
    _move_pointer(session, place, snaps=True)


def _move_pointer(session: Session, place: complex, *, snaps: bool) -> None:
    if session.active_tool:
        session.is_snapping = snaps
        session.active_tool.move(session, place)


def type_in_tool(session: Session, characters: str) -> None:
    """Give what is typed during a drag to the tool in hand."""
    if session.active_tool:
        session.active_tool.type(session, characters)


def release_pointer(session: Session, place: complex) -> None:
    """End what the pointer does where it is."""
    _release_pointer(session, place, insists=False)


def release_pointer_forced(session: Session, place: complex) -> None:
    """End what the pointer does where it is; what it pulls is wanted there, however far that is."""
    _release_pointer(session, place, insists=True)


def _release_pointer(session: Session, place: complex, *, insists: bool) -> None:
    gesture, session.active_tool = session.active_tool, None
    if gesture:
        session.is_forcing_targets = insists
        gesture.end(session, place)


def cancel_tool(session: Session) -> None:
    """End what the pointer does, and take it back."""
    gesture, session.active_tool = session.active_tool, None
    if gesture:
        gesture.cancel(session)


def hover_handle(session: Session, handle: int | None) -> None:
    """Note which handle is under the pointer."""
    session.hovered = handle


def show_hint(session: Session, hint: str) -> None:
    """Show a hint in the status bar."""
    session.hint = hint


def note_space_used(session: Session) -> None:
    """Note that Space was held to move the view, so that letting it go does not play."""
    session.is_space_used = True
