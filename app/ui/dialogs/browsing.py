"""Steps of the built-in file browser, from one state of its dialog to the next."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from app.editor import FileDialog
from app.ui.dialogs.folder_listing import Entry


def mark_entry(dialog: FileDialog, entry: Entry) -> FileDialog:
    name = entry.path.name
    if entry.is_folder:
        return replace(dialog, marked=name, name=dialog.name if dialog.writes else "")
    return replace(dialog, marked=name, name=name)


def enter_folder(dialog: FileDialog, folder: Path) -> FileDialog:
    """Go to another folder. Keep the name of a file to save, unless the name was this folder."""
    left = dialog.folder.name if folder == dialog.folder.parent else ""
    is_path = Path(dialog.name).name != dialog.name
    name = dialog.name if dialog.writes and not is_path else ""
    return replace(dialog, folder=folder, name=name, marked=left)


def chosen_folder(dialog: FileDialog) -> Path | None:
    """Return the marked or typed folder, if it exists."""
    name = dialog.marked or dialog.name.strip()
    is_path = Path(name).name != name
    if not name or (dialog.writes and not dialog.marked and not is_path):
        return None
    folder = (dialog.folder / name).resolve()
    return folder if is_there(Path.is_dir, folder) else None


def chosen_path(dialog: FileDialog) -> Path | None:
    """Return the path of the typed name, if the dialog accepts it."""
    name = dialog.name.strip()
    if not name:
        return None
    path = dialog.path_of(name)
    return path if dialog.writes or is_there(Path.is_file, path) else None


def is_there(kind: Callable[[Path], bool], path: Path) -> bool:
    """Return whether a typed path is a file or a folder, as `kind` tests."""
    try:
        return kind(path)
    except OSError:
        # The name is too long, or a folder before it may not be entered.
        return False
