"""A file dialog of the system: it runs beside the window, which waits for it."""

import shutil
import sys
from pathlib import Path
from typing import Final

from imgui_bundle import portable_file_dialogs

from app.editor import Action, FileDialog, Question, do
from app.editor.actions import choose_file, close_dialog, show_dialog, use_own_file_browser
from app.errors import display_name
from app.export import choose_frame_folder

# Any of them shows the file dialogs of a Linux desktop.
PROGRAMS: Final = ("zenity", "kdialog", "matedialog", "qarma")
# Nobody finds and cancels a dialog so soon: one that is gone by then never came up. The system
# tells no more of the two than that nothing was chosen.
TOO_SOON = 0.5  # seconds
MOST_NAMED = 4  # kinds of files in the name of a filter
REPLACE = "Replace the file?"


def find_system_dialogs() -> str | None:
    """Return what shows the system's own file dialogs, in words; None where nothing does."""
    if sys.platform in {"win32", "darwin"}:
        return "the system's own"
    return next(filter(shutil.which, PROGRAMS), None)


class NativeDialog:
    """One dialog of the system, from its opening, by the clock's seconds, to its answer."""

    def __init__(self, dialog: FileDialog, now: float) -> None:
        self.dialog = dialog
        self._opened = now
        self._running = _open(dialog)

    def poll(self, now: float) -> list[Action]:
        """Return what follows from the person's answer, once it is there; never waits."""
        if not self._running.ready(0):
            return []
        try:
            result = self._running.result()
        except UnicodeDecodeError:
            # A name that is not UTF-8, of which it knows no other form.
            return [do(use_own_file_browser)]
        chosen = result if isinstance(result, str) else next(iter(result), "")
        if chosen:
            return [_follow(self.dialog, Path(chosen))]
        return [do(use_own_file_browser if now - self._opened < TOO_SOON else close_dialog)]

    def close(self) -> None:
        """Take the dialog away if it is still there."""
        if not self._running.ready(0):
            self._running.kill()


Running = (
    portable_file_dialogs.open_file
    | portable_file_dialogs.save_file
    | portable_file_dialogs.select_folder
)


def _open(dialog: FileDialog) -> Running:
    # With a slash at its end a folder is where to begin, and not what to choose.
    folder = display_name(f"{dialog.folder}/")
    if dialog.wants_folder:
        return portable_file_dialogs.select_folder(dialog.title, folder)
    filters = _filters(dialog.suffixes)
    if dialog.writes:
        # macOS begins only at what exists.
        start = folder if sys.platform == "darwin" else display_name(dialog.folder / dialog.name)
        return portable_file_dialogs.save_file(dialog.title, start, filters)
    return portable_file_dialogs.open_file(dialog.title, folder, filters)


def _filters(suffixes: tuple[str, ...]) -> list[str]:
    """Return name and patterns; cameras and old programs write suffixes in capitals."""
    names = ", ".join(suffixes[:MOST_NAMED]) + (", …" if len(suffixes) > MOST_NAMED else "")
    return [names, " ".join(f"*{form}" for s in suffixes for form in (s, s.upper()))]


def _follow(dialog: FileDialog, chosen: Path) -> Action:
    if dialog.wants_folder:
        return do(choose_file, dialog, choose_frame_folder(chosen, dialog.name, dialog.is_frame))
    path = dialog.path_of(str(chosen))
    if path == chosen or not path.exists():
        return do(choose_file, dialog, path)
    # The system has asked about the name without its suffix only.
    question = Question(
        title=REPLACE,
        text=f"{path.name} is there already.",
        answers=(("Replace", do(choose_file, dialog, path)),),
    )
    return do(show_dialog, question)
