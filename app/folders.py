"""The person's own folders: their home, and the folder for settings and unsaved work."""

import os
import sys
from pathlib import Path


def home_folder() -> Path:
    """Return the person's home folder, or the root for a person without one, as in containers.

    It may not exist.
    """
    try:
        return Path.home()
    except RuntimeError:
        return Path(Path.cwd().anchor)


def settings_folder() -> Path:
    """Return the person's folder for settings and unsaved work; it may not exist yet."""
    # Not platformdirs: it heeds XDG_CONFIG_HOME on macOS too, and would lose settings there.
    home = home_folder()
    if sys.platform == "win32":
        return Path(os.environ.get("APPDATA") or home / "AppData" / "Roaming") / "Lissom"
    if sys.platform == "darwin":
        return home / "Library" / "Application Support" / "Lissom"
    # The standard says to ignore a relative path.
    chosen = Path(os.environ.get("XDG_CONFIG_HOME", ""))
    return (chosen if chosen.is_absolute() else home / ".config") / "lissom"


def preferences_file() -> Path:
    """Return the file of the person's preferences; it may not exist yet."""
    return settings_folder() / "preferences.json"
