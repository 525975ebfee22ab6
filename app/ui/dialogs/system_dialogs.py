"""Whether the system has file dialogs of its own."""

import shutil
import sys
from typing import Final

# Any of them shows the file dialogs of a Linux desktop.
PROGRAMS: Final = ("zenity", "kdialog", "matedialog", "qarma")


def find_system_dialogs() -> str | None:
    """Return what shows the system's own file dialogs, in words; None where nothing does."""
    if sys.platform in {"win32", "darwin"}:
        return "the system's own"
    return next(filter(shutil.which, PROGRAMS), None)
