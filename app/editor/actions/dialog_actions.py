"""Dialogs, notices, the manual and the import log: shown, answered and closed."""

import os
import webbrowser
from collections.abc import Mapping
from pathlib import Path

from app.editor import error_reports
from app.editor.action import Action, do
from app.editor.actions.action_spec import ActionSpec, named_action, unless
from app.editor.parts.dialogs import Dialog, FileDialog, ShortcutSheet
from app.editor.parts.notices import Toast
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.errors import ImportLog, LissomError
from app.storage import manual_page
from app.texts import _, ngettext

MANY_EMPTY = 2  # answers of the system's dialogs in a row without a file


def show_dialog(session: Session, dialog: Dialog) -> None:
    """Open a dialog in place of the open one."""
    session.dialogs.show(dialog)


def browse_files(session: Session, dialog: FileDialog) -> None:
    """Set the state of the open file browser."""
    session.dialogs.show(dialog)


def choose_file(session: Session, dialog: FileDialog, path: Path) -> None:
    """Give a path to the file dialog's action; the next file dialog opens in its folder."""
    session.dialogs.close()
    session.dialogs.note_answer()
    session.settings.prefer(folder=path.parent)
    dialog.chosen(path).apply(session)


def use_own_file_browser(session: Session) -> None:
    """From now on, use Lissom's file browser instead of the system's dialogs."""
    session.dialogs.use_own_file_browser()


def replace_system_dialog(session: Session) -> None:
    """Show Lissom's file browser in place of a system's dialog that did not open."""
    use_own_file_browser(session)
    session.notices.show(_("The system's file dialog did not open, so Lissom shows its own."))


def note_empty_answer(session: Session) -> None:
    """Close a system's dialog without an answer; after the second one, offer Lissom's own."""
    dialog = session.dialogs.current
    session.dialogs.close()
    if session.dialogs.note_empty_answer() < MANY_EMPTY or not isinstance(dialog, FileDialog):
        return
    session.notices.show(
        _("Did the system's file dialog not open?"),
        topic="file dialog",
        label=_("Use Lissom's own dialog"),
        action=do(show_own_file_browser, dialog),
    )


def show_own_file_browser(session: Session, dialog: FileDialog) -> None:
    """Ask for a file again, in Lissom's file browser."""
    use_own_file_browser(session)
    session.dialogs.show(dialog)


@named_action(_("Keys and mouse"), "Shift+F1", needs_project=False)
def show_shortcuts(session: Session) -> None:
    session.dialogs.show(ShortcutSheet())


def edit_shortcut_sheet(session: Session, sheet: ShortcutSheet) -> None:
    """Set the state of the open list of shortcuts."""
    session.dialogs.show(sheet)


def choose_keys(session: Session, keys: Mapping[str, str], sheet: ShortcutSheet) -> None:
    """Set the keys that differ from the actions' own, by labels; show the list of shortcuts."""
    session.settings.prefer(keys=dict(keys))
    session.dialogs.show(sheet)


REPORT = ActionSpec(
    do(error_reports.show_kept_or_new_report), _("Report a problem…"), needs_project=False
)


def open_manual(session: Session, page: str) -> None:
    """Show a page of the manual in the browser, and show its address in a notice.

    Terminal browsers are skipped, since they would block the window, unless BROWSER names one.
    """
    path = manual_page(page)
    try:
        browser = webbrowser.get()
        is_apart = type(browser) is not webbrowser.GenericBrowser or "BROWSER" in os.environ
        is_open = is_apart and browser.open(path.as_uri())
    except (webbrowser.Error, OSError):
        is_open = False
    if not is_open:
        raise LissomError(_("no browser was found; the manual is {path}").format(path=path))
    # The program that starts the browser may fail later, without an error here.
    text = _("The manual opens in the browser. Its file is {path}.")
    session.notices.show(text.format(path=path), topic="manual")


def close_dialog(session: Session) -> None:
    """Close the dialog without an action; the dialog below a report returns."""
    session.dialogs.close()


def answer_dialog(session: Session, action: Action) -> None:
    """Close the dialog and run the chosen action."""
    session.dialogs.close()
    action.apply(session)


def show_notice(session: Session, text: str) -> None:
    session.notices.show(text)


def dismiss_toast(session: Session, toast: Toast) -> None:
    session.notices.dismiss(toast)


def show_import_notice(session: Session, project: Project, summary: ImportLog) -> None:
    """Show a notice about effects of a drawing that its import lost."""
    if not summary.warnings:
        return
    project.layer_list.show_import_log(shown=True)
    count = len(summary.warnings)
    session.notices.show(
        ngettext(
            "One thing looks different here. See the Layers tab.",
            "{count} things look different here. See the Layers tab.",
            count,
        ).format(count=count),
        topic="import",
        label=_("Show"),
        action=do(show_import_log),
    )


@named_action(
    _("Import log"),
    why_disabled=unless(
        lambda _, project: project.document.import_log, _("There is nothing in the import log.")
    ),
)
@with_project
def show_import_log(session: Session, project: Project) -> None:
    """Show the import log in the panel of layers."""
    project.layer_list.show_import_log(shown=True)
    session.display.focus_panel("Layers")


@with_project
def toggle_import_log(_: Session, project: Project) -> None:
    """Show or hide the import log in the panel of layers."""
    project.layer_list.show_import_log(shown=not project.layer_list.is_import_log_open)
