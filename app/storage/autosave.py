"""Unsaved work that survives a crash: one file for each running window, removed when it is safe."""

import ctypes
import os
import re
import secrets
import sys
from pathlib import Path

from app.document import Document
from app.storage.project_file import save_project

SYNCHRONIZE, WAIT_TIMEOUT = 0x00100000, 0x102  # of the system calls of Windows
SECONDS = 20.0  # between a change and its autosave, at least
_NAME = re.compile(r"unsaved-(\d+)(?:-(\w+))?\.lissom")
# A number of a process is given again to a later one, in a sandbox always.
_OWN = (os.getpid(), secrets.token_hex(4))


def write_autosave(folder: Path, document: Document) -> None:
    """Keep the document of this process, in place of an earlier one."""
    folder.mkdir(parents=True, exist_ok=True)
    save_project(_path(folder), document)


def forget_autosave(folder: Path) -> None:
    """Remove what this process kept."""
    _path(folder).unlink(missing_ok=True)


def find_leftovers(folder: Path) -> list[Path]:
    """Return what processes kept that are gone, the newest first."""
    found = []
    for path in folder.glob("unsaved-*.lissom"):
        match = _NAME.fullmatch(path.name)
        if match and not _is_kept(int(match[1]), match[2]):
            found.append(path)
    return sorted(found, key=lambda path: path.stat().st_mtime, reverse=True)


def _path(folder: Path) -> Path:
    return folder / "unsaved-{}-{}.lissom".format(*_OWN)


def _is_kept(process: int, token: str | None) -> bool:
    """Tell whether the process that wrote a file is still running."""
    if process == _OWN[0]:
        return token == _OWN[1]
    return _is_running(process)


def _is_running(process: int) -> bool:
    if sys.platform == "win32":
        # Signal 0 is no question there, but Ctrl+C.
        kernel = ctypes.windll.kernel32
        handle = kernel.OpenProcess(SYNCHRONIZE, False, process)  # noqa: FBT003 - the system's call
        is_running = bool(handle) and kernel.WaitForSingleObject(handle, 0) == WAIT_TIMEOUT
        kernel.CloseHandle(handle)
        return is_running
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        # It exists, but is another person's.
        return True
    return True
