"""The folder shortcuts beside the list of the built-in file browser."""

import os
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from imgui_bundle import icons_fontawesome_6 as icons

from app.errors import display_name
from app.folders import home_folder
from app.texts import _

MOST_RECENT = 5
# Default folder name, and key in the desktop's file user-dirs.dirs.
FOLDERS = (
    ("Desktop", "DESKTOP", icons.ICON_FA_DESKTOP),
    ("Documents", "DOCUMENTS", icons.ICON_FA_FILE_LINES),
    ("Downloads", "DOWNLOAD", icons.ICON_FA_DOWNLOAD),
    ("Pictures", "PICTURES", icons.ICON_FA_IMAGE),
)


class BrowserShortcut(NamedTuple):
    folder: Path
    name: str
    icon: str


def list_standard_shortcuts() -> tuple[BrowserShortcut, ...]:
    """Return the home folder and its usual subfolders, if they exist."""
    home = home_folder()
    named = _named_by_desktop(home)
    places = [BrowserShortcut(home, _("Home folder"), icons.ICON_FA_HOUSE)]
    for name, key, icon in FOLDERS:
        folder = named.get(key, home / name)
        if folder != home and _is_there(folder):
            places.append(BrowserShortcut(folder, display_name(folder.name), icon))
    return tuple(places)


def list_recent_shortcuts(recent: Iterable[Path]) -> tuple[BrowserShortcut, ...]:
    """Return the folders of recently opened files, the newest first."""
    folders = dict.fromkeys(path.parent for path in recent)
    found = [folder for folder in folders if _is_there(folder)]
    icon = icons.ICON_FA_CLOCK_ROTATE_LEFT
    return tuple(
        BrowserShortcut(folder, display_name(folder.name or folder), icon)
        for folder in found[:MOST_RECENT]
    )


def _named_by_desktop(home: Path) -> dict[str, Path]:
    """Return the folders of user-dirs.dirs, as in freedesktop.org's xdg-user-dirs."""
    if sys.platform in {"win32", "darwin"}:
        return {}
    settings = Path(os.environ.get("XDG_CONFIG_HOME") or home / ".config")
    try:
        text = (settings / "user-dirs.dirs").read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return {}
    found = re.findall(r'^XDG_([A-Z]+)_DIR="(\$HOME)?(/[^"]*)"', text, re.MULTILINE)
    return {
        name: home / place.strip("/") if in_home else Path(place) for name, in_home, place in found
    }


def _is_there(folder: Path) -> bool:
    try:
        return folder.is_dir()
    except OSError:
        return False
