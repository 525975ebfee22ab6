"""Pointer events in the viewport: the tool that takes a press gets all events until the release."""

from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.tools.table import tools_of
from app.editor.tools.tool import PointerHit


@with_project
def press_pointer(session: Session, project: Project, spot: PointerHit) -> None:
    """Pass a press to the first tool that takes it."""
    if project.layer_runtime.shown is not None:
        gestures = (tool.press(session, project, spot) for tool in tools_of(session))
        session.tools.begin(next((gesture for gesture in gestures if gesture is not None), None))


def move_pointer(session: Session, place: complex) -> None:
    """Pass the pointer's place in the scene to the active tool."""
    _move_pointer(session, place, snaps=False)


def move_pointer_in_steps(session: Session, place: complex) -> None:
    """Pass the pointer's place to the active tool; rotations snap to steps."""
    _move_pointer(session, place, snaps=True)


def _move_pointer(session: Session, place: complex, *, snaps: bool) -> None:
    if session.tools.active_tool:
        session.tools.snap(snaps=snaps)
        session.tools.active_tool.move(session, place)


def type_in_tool(session: Session, characters: str) -> None:
    """Pass characters typed during a drag to the active tool."""
    if session.tools.active_tool:
        session.tools.active_tool.type(session, characters)


def release_pointer(session: Session, place: complex) -> None:
    """End the active tool."""
    _release_pointer(session, place, forces_targets=False)


def release_pointer_forced(session: Session, place: complex) -> None:
    """End the active tool; targets stay even if the handles cannot reach them."""
    _release_pointer(session, place, forces_targets=True)


def _release_pointer(session: Session, place: complex, *, forces_targets: bool) -> None:
    gesture = session.tools.end()
    if gesture:
        session.tools.force_targets(forces=forces_targets)
        gesture.end(session, place)


def cancel_tool(session: Session) -> None:
    """Cancel the active tool, and undo its edits."""
    gesture = session.tools.end()
    if gesture:
        gesture.cancel(session)


def hover_handle(session: Session, handle: int | None) -> None:
    """Note the handle under the pointer."""
    session.tools.hover(handle)


def show_hint(session: Session, hint: str, source: str = "") -> None:
    session.tools.show_hint(hint, source)


def note_widget_in_use(session: Session, widget: int, *, is_pressed: bool) -> None:
    """Note the number of the widget in use, 0 for none, and whether the pointer presses it.

    Commands of one use of a widget are one undo step.
    """
    if session.project is not None:
        session.project.history.release(session.tools.widget_gesture)
    session.tools.use_widget(widget, is_pressed=is_pressed)


def note_space_used(session: Session) -> None:
    """Note that Space was held to pan the view, so that its release does not play."""
    session.tools.use_space(used=True)
