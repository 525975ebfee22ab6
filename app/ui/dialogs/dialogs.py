"""The open dialog: a question, the sheet of shortcuts, or a file dialog."""

from imgui_bundle import ImVec2, imgui

from app.editor import (
    Action,
    Dialog,
    FileDialog,
    ProblemReport,
    Question,
    RecoveryDialog,
    ReloadDialog,
    Session,
    ShortcutSheet,
    do,
    error_reports,
)
from app.editor.actions.dialog_actions import (
    answer_dialog,
    browse_files,
    choose_keys,
    close_dialog,
    edit_shortcut_sheet,
    replace_system_dialog,
    use_own_file_browser,
)
from app.errors import display_name
from app.texts import _
from app.ui.dialogs.file_browser import FileBrowser, LookUp
from app.ui.dialogs.native_dialog import NativeDialog
from app.ui.dialogs.problem import draw_problem_dialog
from app.ui.dialogs.recovery import draw_recovery_dialog
from app.ui.dialogs.reload import draw_reload_dialog
from app.ui.dialogs.shortcut_sheet import draw_shortcut_sheet
from app.ui.style.theme import Look
from app.ui.style.widgets import main_button

GOING_ON = (
    browse_files,
    replace_system_dialog,
    use_own_file_browser,
    error_reports.edit_report_text,
    edit_shortcut_sheet,
    choose_keys,
)  # with the open dialog


class Dialogs:
    """Shows the session's dialog. At most one system dialog is open."""

    def __init__(self) -> None:
        self._browser = FileBrowser()
        self._native: NativeDialog | None = None

    def draw(self, session: Session, look: Look, thumbnail: LookUp) -> list[Action]:
        self._follow_session(session)
        dialog = session.dialogs.current
        _use_keyboard(is_used=isinstance(dialog, (Question, RecoveryDialog, ReloadDialog)))
        if dialog is None:
            return []
        title = _title(dialog)
        imgui.open_popup(f"{title}###dialog")
        viewport = imgui.get_main_viewport()
        middle = viewport.get_center()
        imgui.set_next_window_pos(middle, imgui.Cond_.always, ImVec2(0.5, 0.5))
        imgui.set_next_window_size_constraints(
            ImVec2(24 * look.em, 0), ImVec2(viewport.size.x * 0.9, viewport.size.y * 0.9)
        )
        flags = imgui.WindowFlags_.always_auto_resize | imgui.WindowFlags_.no_move
        imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.6 * look.em)
        visible, open_ = imgui.begin_popup_modal(f"{title}###dialog", True, flags)  # noqa: FBT003
        imgui.pop_style_var()
        if not visible:
            return [do(close_dialog)]
        actions = self._contents(dialog, session, look, thumbnail)
        asks_for_keys = isinstance(dialog, ShortcutSheet) and dialog.changed
        if not open_ or (imgui.is_key_pressed(imgui.Key.escape) and not asks_for_keys):
            actions.append(do(close_dialog))
        if any(action.verb not in GOING_ON for action in actions):
            imgui.close_current_popup()
        imgui.end_popup()
        return actions

    def close(self) -> None:
        """Close the system's dialog. Otherwise the program would wait for it at its end."""
        if self._native is not None:
            self._native.close()
            self._native = None

    def _follow_session(self, session: Session) -> None:
        """Open and close system dialogs to match the session."""
        dialog = session.dialogs.current if session.dialogs.uses_system else None
        if self._native is not None and self._native.dialog is not dialog:
            self.close()
        if self._native is None and isinstance(dialog, FileDialog):
            self._native = NativeDialog(dialog, session.clock())

    def _contents(
        self, dialog: Dialog, session: Session, look: Look, thumbnail: LookUp
    ) -> list[Action]:
        match dialog:
            case Question():
                return _question(dialog, look)
            case FileDialog() if self._native is not None:
                return [*_waiting(look), *self._native.poll(session.clock())]
            case FileDialog():
                return self._browser.draw(dialog, session, look, thumbnail)
        return _other_contents(dialog, session, look)


def _other_contents(dialog: Dialog, session: Session, look: Look) -> list[Action]:
    """Draw a dialog that is neither a question nor a file dialog."""
    match dialog:
        case ReloadDialog():
            return draw_reload_dialog(dialog, look)
        case RecoveryDialog():
            return draw_recovery_dialog(dialog, look)
        case ProblemReport():
            return draw_problem_dialog(dialog, look)
        case ShortcutSheet():
            return draw_shortcut_sheet(dialog, session, look)
    return []


def _title(dialog: Dialog) -> str:
    match dialog:
        case RecoveryDialog():
            return _("Unsaved work")
        case ProblemReport():
            return _("Report a problem")
        case ReloadDialog():
            return _("Reload {name}").format(name=display_name(dialog.path.name))
        case ShortcutSheet():
            return _("Keys and mouse")
    return dialog.title


def _use_keyboard(*, is_used: bool) -> None:
    """Let Tab and arrows move between buttons, and Enter press one.

    Elsewhere these keys have other meanings: arrows nudge handles, Space plays.
    """
    io, flag = imgui.get_io(), imgui.ConfigFlags_.nav_enable_keyboard
    if bool(io.config_flags & flag) == is_used:
        return
    io.config_flags ^= flag
    # Visible while keys press a button. After the question the cursor would mark something else.
    imgui.set_nav_cursor_visible(is_used)


def _waiting(look: Look) -> list[Action]:
    imgui.text_unformatted(_("Choose a file in the system's dialog, which is a separate window."))
    imgui.dummy(ImVec2(0, 0.4 * look.em))
    if imgui.button(_("Use Lissom's own dialog")):
        return [do(use_own_file_browser)]
    imgui.same_line()
    if imgui.button(_("Cancel")):
        return [do(close_dialog)]
    return []


def _question(question: Question, look: Look) -> list[Action]:
    actions: list[Action] = []
    # Keys press a button only while the cursor shows which one.
    imgui.set_nav_cursor_visible(True)
    imgui.push_text_wrap_pos(30 * look.em)
    imgui.text_unformatted(display_name(question.text))
    imgui.pop_text_wrap_pos()
    imgui.dummy(ImVec2(0, 0.4 * look.em))
    for index, (text, action) in enumerate(question.answers):
        if index:
            imgui.same_line()
        is_main = index == 0
        if main_button(look, text) if is_main else imgui.button(text):
            actions.append(do(answer_dialog, action))
        if is_main:
            imgui.set_item_default_focus()
    imgui.same_line()
    if imgui.button(_("Cancel")):
        actions.append(do(close_dialog))
    return actions
