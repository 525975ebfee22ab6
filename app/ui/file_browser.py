"""Our own file browser, for machines without a native file dialog."""

import os
from dataclasses import replace
from pathlib import Path

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from app.actions.action import Action, do
from app.actions.viewing import answer, close_dialog, show_dialog
from app.session import FileDialog
from app.ui.theme import Look
from app.ui.widgets import main_button, small

WIDTH, HEIGHT = 40.0, 22.0  # em
MOST = 2000  # entries shown of one folder


def draw(dialog: FileDialog, look: Look) -> list[Action]:
    """Draw the browser in the dialog's window."""
    actions: list[Action] = []
    actions += _places(dialog, look)
    folders, files, problem = _contents(dialog.folder, dialog.suffixes)
    picked = _listing(dialog, look, folders, files)
    if problem:
        small(look, problem)
    name, opened = dialog.name, False
    match picked:
        case (folder, _) if folder is not None and folder.is_dir():
            return [*actions, do(show_dialog, replace(dialog, folder=folder))]
        case (file, double) if file is not None:
            name, opened = file.name, double
    imgui.set_next_item_width(WIDTH * look.em)
    entered, name = imgui.input_text_with_hint(
        "##name", "File name", name, imgui.InputTextFlags_.enter_returns_true
    )
    if imgui.is_item_edited() or name != dialog.name:
        actions.append(do(show_dialog, replace(dialog, name=name)))
    path = _path(dialog, name)
    possible = bool(name.strip()) and (dialog.writes or path.is_file())
    text = "Save" if dialog.writes else "Open"
    if path.exists() and dialog.writes:
        small(look, f"{path.name} is there already and will be replaced.")
    clicked = main_button(look, text, 6 * look.em, enabled=possible)
    imgui.same_line()
    if imgui.button("Cancel", ImVec2(6 * look.em, 0)):
        return [do(close_dialog)]
    if possible and (clicked or opened or entered):
        return [do(answer, dialog.chosen(path))]
    return actions


def _places(dialog: FileDialog, look: Look) -> list[Action]:
    actions = []
    if imgui.button(f"{icons.ICON_FA_ARROW_UP}###up"):
        actions.append(do(show_dialog, replace(dialog, folder=dialog.folder.parent)))
    imgui.same_line()
    if imgui.button(f"{icons.ICON_FA_HOUSE}###home"):
        actions.append(do(show_dialog, replace(dialog, folder=Path.home())))
    imgui.same_line()
    parts = [*reversed(dialog.folder.parents), dialog.folder][-4:]
    for folder in parts:
        if imgui.small_button(f"{folder.name or folder.anchor}###{folder}"):
            actions.append(do(show_dialog, replace(dialog, folder=folder)))
        imgui.same_line(0, 0.2 * look.em)
    imgui.new_line()
    return actions


def _contents(folder: Path, suffixes: tuple[str, ...]) -> tuple[list[Path], list[Path], str]:
    try:
        with os.scandir(folder) as entries:
            visible = [entry for entry in entries if not entry.name.startswith(".")]
            folders = [Path(entry.path) for entry in visible if entry.is_dir()]
            files = [
                Path(entry.path)
                for entry in visible
                if entry.is_file() and Path(entry.name).suffix.lower() in suffixes
            ]
    except OSError as error:
        return [], [], f"This folder cannot be read: {error.strerror or error}"
    problem = f"Only the first {MOST} entries are shown." if len(visible) > MOST else ""
    return sorted(folders)[:MOST], sorted(files)[:MOST], problem


def _listing(
    dialog: FileDialog, look: Look, folders: list[Path], files: list[Path]
) -> tuple[Path | None, bool]:
    """Draw the entries; return the one that was clicked, and whether it was a double click."""
    picked: tuple[Path | None, bool] = (None, False)
    imgui.begin_child(
        "entries", ImVec2(WIDTH * look.em, HEIGHT * look.em), imgui.ChildFlags_.borders
    )
    for path, icon in [(p, icons.ICON_FA_FOLDER) for p in folders] + [
        (p, icons.ICON_FA_FILE) for p in files
    ]:
        imgui.text_colored(look.palette.dim, icon)
        imgui.same_line(1.8 * look.em)
        clicked, _ = imgui.selectable(
            f"{path.name}###{path}",
            path.name == dialog.name,
            imgui.SelectableFlags_.allow_double_click | imgui.SelectableFlags_.no_auto_close_popups,
        )
        if clicked:
            picked = (path, imgui.is_mouse_double_clicked(imgui.MouseButton_.left))
    if not folders and not files:
        imgui.text_disabled("Nothing here.")
    imgui.end_child()
    return picked


def _path(dialog: FileDialog, name: str) -> Path:
    path = dialog.folder / name.strip()
    if dialog.writes and not path.suffix and dialog.suffixes:
        path = path.with_suffix(dialog.suffixes[0])
    return path
