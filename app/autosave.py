"""Unsaved work that survives a crash: one file for each running window, removed when it is safe."""

import os
import re
from pathlib import Path

from app.document.model import Document
from app.document.project_file import save_project

SECONDS = 20.0  # between a change and its autosave, at least
_NAME = re.compile(r"unsaved-(\d+)\.lissom")


def write_autosave(folder: Path, document: Document) -> None:
    """Keep the document of this process, in place of an earlier one."""
    folder.mkdir(parents=True, exist_ok=True)
    save_project(_path(folder, os.getpid()), document)


def forget_autosave(folder: Path) -> None:
    """Remove what this process kept."""
    _path(folder, os.getpid()).unlink(missing_ok=True)


def find_leftovers(folder: Path) -> list[Path]:
    """Return what processes kept that are gone, the newest first."""
    found = []
    for path in folder.glob("unsaved-*.lissom"):
        match = _NAME.fullmatch(path.name)
        if match and not _is_running(int(match[1])):
            found.append(path)
    return sorted(found, key=lambda path: path.stat().st_mtime, reverse=True)


def _path(folder: Path, process: int) -> Path:
    return folder / f"unsaved-{process}.lissom"


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        # It exists, but is another person's.
        return True
    return True
