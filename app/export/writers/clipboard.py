"""The system's clipboard for pictures."""

import os
import shutil
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import Final

from app.errors import LissomError
from app.storage import lock
from app.texts import _

_PATIENCE: Final = 20  # seconds
_POWERSHELL: Final = (
    "Add-Type -AssemblyName System.Windows.Forms, System.Drawing; [Windows.Forms.Clipboard]::"
    "SetImage([Drawing.Image]::FromFile($env:LISSOM_PICTURE))"
)
_OSASCRIPT: Final = (
    'set the clipboard to (read (POSIX file (system attribute "LISSOM_PICTURE")) as «class PNGf»)'
)


def clipboard_program() -> tuple[str, ...]:
    """Return the command that takes a PNG file from its standard input or LISSOM_PICTURE.

    Raises `LissomError` if this system has no such command.
    """
    if sys.platform == "win32":
        return ("powershell", "-NoProfile", "-STA", "-Command", _POWERSHELL)
    if sys.platform == "darwin":
        return ("osascript", "-e", _OSASCRIPT)
    if os.environ.get("WAYLAND_DISPLAY") and shutil.which("wl-copy"):
        return ("wl-copy", "--type", "image/png")
    if os.environ.get("DISPLAY") and shutil.which("xclip"):
        return ("xclip", "-selection", "clipboard", "-target", "image/png")
    needed = "wl-clipboard" if os.environ.get("WAYLAND_DISPLAY") else "xclip"
    raise LissomError(
        _(
            "no program here copies pictures to the clipboard. Install {needed} (sudo apt "
            "install {needed}), or export the picture as a file"
        ).format(needed=needed)
    )


def put_on_clipboard(picture: Path) -> None:
    """Put a PNG file on the clipboard. The file may be deleted afterwards.

    Raises `LissomError` if the system refuses the picture.
    """
    command = clipboard_program()
    try:
        with picture.open("rb") as file:
            if sys.platform != "win32":
                with suppress(OSError):  # without locks another starting window may remove the file
                    lock(file.fileno())
            # The program may keep running to serve the clipboard, so nothing waits for its end.
            subprocess.run(  # noqa: S603 - a fixed command
                command,
                stdin=file,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env={**os.environ, "LISSOM_PICTURE": str(picture)},
                timeout=_PATIENCE,
                check=True,
            )
    except (OSError, subprocess.SubprocessError) as error:
        raise LissomError(
            _(
                "{command} could not copy the picture to the clipboard; export the picture as a "
                "file"
            ).format(command=command[0])
        ) from error
