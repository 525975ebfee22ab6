"""A file dialog of the system. It runs beside the window, which waits for the answer."""

import shutil
import sys
from pathlib import Path
from typing import Final

from imgui_bundle import portable_file_dialogs

from app.editor import Action, FileDialog, Question, do
from app.editor.actions.dialog_actions import (
    choose_file,
    note_empty_answer,
    replace_system_dialog,
    show_dialog,
)
from app.errors import display_name
from app.export import choose_frame_folder
from app.texts import _
from app.ui.dialogs.dialog_program import DialogProgram

# Each of these programs shows the file dialogs of a Linux desktop.
PROGRAMS: Final = ("zenity", "kdialog", "matedialog", "qarma")
# A person cannot cancel a dialog so soon. A dialog that ends earlier never appeared: the system
# reports in both cases only that nothing was chosen.
TOO_SOON = 0.5  # seconds
MOST_NAMED = 4  # suffixes in the name of a filter
REPLACE = _("Replace the file?")


def find_system_dialogs() -> str | None:
    """Return the name of the program that shows the system's file dialogs, or None."""
    if sys.platform in {"win32", "darwin"}:
        return _("the system's own")
    return next(filter(shutil.which, PROGRAMS), None)


class NativeDialog:
    """A dialog of the system, from its opening to its answer. Times are in clock seconds."""

    def __init__(self, dialog: FileDialog, now: float) -> None:
        self.dialog = dialog
        self._opened = now
        self._running = _open(dialog)

    def poll(self, now: float) -> list[Action]:
        """Return the actions of the person's answer, if there is one. Never waits."""
        if isinstance(self._running, DialogProgram):
            if not self._running.is_over:
                return []
            chosen, has_failed = self._running.answer(), self._running.has_failed
        else:
            if not self._running.ready(0):
                return []
            result = self._running.result()
            chosen = result if isinstance(result, str) else next(iter(result), "")
            has_failed = False
        if chosen and not has_failed:
            return [_follow(self.dialog, Path(chosen))]
        if has_failed or now - self._opened < TOO_SOON:
            return [do(replace_system_dialog)]
        return [do(note_empty_answer)]

    def close(self) -> None:
        if isinstance(self._running, DialogProgram):
            self._running.close()
        elif not self._running.ready(0):
            self._running.kill()


Running = (
    DialogProgram
    | portable_file_dialogs.open_file
    | portable_file_dialogs.save_file
    | portable_file_dialogs.select_folder
)


def _open(dialog: FileDialog) -> Running:
    if sys.platform not in {"win32", "darwin"}:
        # Started here, because the library does not tell a failure from a cancelled dialog.
        program = find_system_dialogs()
        if program is not None:
            return DialogProgram(program, dialog, _filters(dialog.suffixes))
    # With a slash at its end, the folder is where to begin and not the preselected file.
    folder = display_name(f"{dialog.folder}/")
    if dialog.wants_folder:
        return portable_file_dialogs.select_folder(dialog.title, folder)
    filters = [*_filters(dialog.suffixes)]
    if dialog.writes:
        # macOS accepts only an existing start folder.
        start = folder if sys.platform == "darwin" else display_name(dialog.folder / dialog.name)
        return portable_file_dialogs.save_file(dialog.title, start, filters)
    return portable_file_dialogs.open_file(dialog.title, folder, filters)


def _filters(suffixes: tuple[str, ...]) -> tuple[str, str]:
    """Return names and patterns of the filter. Cameras and old programs write capital suffixes."""
    names = ", ".join(suffixes[:MOST_NAMED]) + (", …" if len(suffixes) > MOST_NAMED else "")
    return names, " ".join(f"*{form}" for s in suffixes for form in (s, s.upper()))


def _follow(dialog: FileDialog, chosen: Path) -> Action:
    if dialog.wants_folder:
        return do(choose_file, dialog, choose_frame_folder(chosen, dialog.name, dialog.is_frame))
    path = dialog.path_of(str(chosen))
    if path == chosen or not path.exists():
        return do(choose_file, dialog, path)
    # The system has asked only about the name without its suffix.
    question = Question(
        title=REPLACE,
        text=_("{name} already exists.").format(name=path.name),
        answers=((_("Replace"), do(choose_file, dialog, path)),),
    )
    return do(show_dialog, question)
