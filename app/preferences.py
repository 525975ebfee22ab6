"""What a person chose for all projects, and where that and unsaved work are kept."""

import json
import os
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

from app.errors import LissomError
from app.files import write_atomically

ThemeName = Literal["dark", "light"]
SMALLEST_SCALE, LARGEST_SCALE = 0.75, 3.0
MOST_RECENT = 10


@dataclass(frozen=True, slots=True, kw_only=True)
class Preferences:
    """What the person chose for all projects.

    Parameters
    ----------
    theme : str
    scale : float
        Of the whole interface.
    auto_key : bool
        Whether posing makes and changes keys by itself.
    recent : tuple of Path
        Files opened or saved last, the newest first.
    folder : Path, optional
        Where a file was chosen last.
    """

    theme: ThemeName = "dark"
    scale: float = 1.0
    auto_key: bool = True
    recent: tuple[Path, ...] = ()
    folder: Path | None = None

    def with_recent(self, path: Path) -> "Preferences":
        """Return the preferences with a file as the most recent one."""
        others = (other for other in self.recent if other != path)
        return replace(self, recent=(path, *others)[:MOST_RECENT], folder=path.parent)


def settings_folder() -> Path:
    """Return the folder for settings and unsaved work of this person; it may not exist yet."""
    home = Path.home()
    if sys.platform == "win32":
        return Path(os.environ.get("APPDATA", home / "AppData" / "Roaming")) / "Lissom"
    if sys.platform == "darwin":
        return home / "Library" / "Application Support" / "Lissom"
    return Path(os.environ.get("XDG_CONFIG_HOME") or home / ".config") / "lissom"


def load_preferences(folder: Path) -> Preferences:
    """Read the preferences; what is missing or makes no sense is as it is at first."""
    try:
        content = json.loads((folder / "preferences.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return Preferences()
    return _understood(content) if isinstance(content, dict) else Preferences()


def save_preferences(folder: Path, preferences: Preferences) -> None:
    """Write the preferences; where that fails, they are as before next time."""
    content = {
        "theme": preferences.theme,
        "scale": preferences.scale,
        "auto_key": preferences.auto_key,
        "recent": [str(path) for path in preferences.recent],
        "folder": None if preferences.folder is None else str(preferences.folder),
    }
    text = json.dumps(content, indent=1).encode()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write_atomically(folder / "preferences.json", lambda file: file.write(text))
    except (OSError, LissomError):
        return


def _understood(content: dict[str, Any]) -> Preferences:
    first = Preferences()
    scale = content.get("scale")
    is_scale = isinstance(scale, (int, float)) and SMALLEST_SCALE <= scale <= LARGEST_SCALE
    recent = content.get("recent")
    paths = recent if isinstance(recent, list) else []
    folder = content.get("folder")
    return Preferences(
        theme="light" if content.get("theme") == "light" else "dark",
        scale=float(scale) if is_scale and scale is not None else first.scale,
        auto_key=content.get("auto_key") is not False,
        recent=tuple(Path(path) for path in paths if isinstance(path, str))[:MOST_RECENT],
        folder=Path(folder) if isinstance(folder, str) else None,
    )
