"""The actions of the window, applied in order; those that follow an unfinished pose wait."""

from collections.abc import Callable, Iterable
from contextlib import nullcontext

from app.document import UnfinishedStepError
from app.editor import Action, Session
from app.editor.actions import viewing
from app.editor.actions.dialog_actions import dismiss_toast
from app.editor.actions.project_files import export_settings
from app.editor.actions.timing import timeline_drag
from app.editor.tools import tool_pointer

PATIENCE = 0.2  # seconds for which the window stands still until a pose rests
# Actions that follow automatically in each frame, and not from the person.
UNLOGGED = {
    dismiss_toast,
    export_settings.preview_export_frame,
    tool_pointer.show_hint,
    tool_pointer.hover_handle,
    tool_pointer.note_widget_in_use,
    timeline_drag.scroll_to_playhead,
    viewing.focus_timeline,
    viewing.set_viewport_size,
}


class ActionQueue:
    """Applies actions to a session.

    An action that changes the document has to follow the pose of an earlier drag. If the pose does
    not rest soon, this action and all later ones wait, while the window goes on to draw.
    """

    def __init__(self, session: Session, report_error: Callable[[Exception], None]) -> None:
        self.waiting: list[Action] = []
        self._session = session
        self._report_error = report_error

    def apply(self, actions: Iterable[Action]) -> None:
        """Apply the waiting actions, then new ones, unless they wait on."""
        actions = [*self.waiting, *actions]
        done = 0
        while done < len(actions) and self._apply(actions[done]):
            done += 1
        self.waiting = actions[done:]

    def deliver(self) -> None:
        """Deliver results of jobs while a widget is in use, which has not asked for them."""
        with self._session.tools.without_widget():
            self._session.jobs.deliver()

    def _apply(self, action: Action) -> bool:
        """Apply an action; return False if it has to wait."""
        project = self._session.project
        if project is not None and project.drag is not None and project.drag.is_awaited:
            return False
        if action.verb not in UNLOGGED:
            self._session.diagnostics.log_action(action.name)
        try:
            with (
                nullcontext() if project is None else project.history.limited(PATIENCE),
                self._session.tools.without_widget() if action.is_by_key else nullcontext(),
            ):
                action.apply(self._session)
        except UnfinishedStepError:
            return False
        except Exception as error:  # noqa: BLE001 - part of the frame guard
            self._report_error(error)
        return True
