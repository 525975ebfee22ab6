"""Unsaved work that survives a crash: one file for each running window, removed when it is safe.

Beside each file lies one that its window holds a lock on. The system lets go of a lock however a
process ends, whereas a process's number is soon given to another one and proves nothing.
"""

import json
import os
import secrets
import threading
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from app.document import Document
from app.errors import LissomError, display_name
from app.storage.files import is_locked, lock, read_file, write_atomically
from app.storage.preferences import make_settings_folder
from app.storage.project_file import load_member, load_project, save_project

SECONDS = 20.0  # between a change and its autosave, at least
# The member of the file that tells where the work came from; projects that are saved have none.
SOURCE_INFO = "origin.json"
LARGEST_SOURCE_INFO = 100_000  # bytes
# Of what ended the program, before and after the person was told of it; what Python tells of it.
REPORT, SEEN_REPORT, FAULT_LOG = "report.txt", "report-told.txt", "faults.txt"
LARGEST_REPORT = 1_000_000  # bytes


class SourceInfo(NamedTuple):
    """What unsaved work is called, and the project file that it belongs to, if there is one."""

    name: str
    path: Path | None


UNKNOWN_SOURCE = SourceInfo("recovered", None)


class Autosave:
    """The unsaved work of one window.

    Parameters
    ----------
    folder : Path
        Where it is kept; made when there is something to keep.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / f"unsaved-{secrets.token_hex(8)}.lissom"
        self._lock: int | None = None
        self._writing = threading.Lock()

    def write(self, document: Document, origin: SourceInfo) -> None:
        """Keep a document and where it came from, in place of an earlier one.

        What another thread still writes is waited for, so that the last one asked for stays.
        """
        told = json.dumps({"name": origin.name, "path": origin.path and str(origin.path)}).encode()
        # One file with both, so that they are of one time however this ends.
        members = MappingProxyType({**document.unknown_members, SOURCE_INFO: told})
        with self._writing:
            self._prepare()
            save_project(self._path, replace(document, unknown_members=members), is_private=True)

    def remove(self) -> None:
        """Remove what was kept."""
        self._path.unlink(missing_ok=True)
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None
            _lock_of(self._path).unlink(missing_ok=True)

    def _prepare(self) -> None:
        """Make the folder, and take the lock."""
        make_settings_folder(self._path.parent)
        if self._lock is None:
            # Without locks other windows offer this work while it is still in use, which loses
            # nothing; hidden after a crash, it would be lost.
            with suppress(OSError):
                self._lock = os.open(_lock_of(self._path), os.O_RDWR | os.O_CREAT, 0o600)
                # Another window that looks for what is left holds it for a moment.
                while not lock(self._lock):
                    pass


def find_recoverable_files(folder: Path) -> list[Path]:
    """Return the files of unsaved work whose windows are gone, the newest first."""
    found = {}
    for path in folder.glob("unsaved-*.lissom"):
        if not is_locked(_lock_of(path)):
            with suppress(OSError):  # its window has just forgotten it
                found[path] = path.stat().st_mtime
    return sorted(found, key=lambda path: found[path], reverse=True)


def load_recoverable_file(path: Path) -> tuple[Document, SourceInfo]:
    """Read unsaved work, and where it came from."""
    document = load_project(path)
    attachments = dict(document.unknown_members)
    origin = _parse_source_info(attachments.pop(SOURCE_INFO, b""))
    return replace(document, unknown_members=MappingProxyType(attachments)), origin


def read_source_info(path: Path) -> SourceInfo:
    """Return where unsaved work came from, without reading the work itself."""
    return _parse_source_info(load_member(path, SOURCE_INFO, LARGEST_SOURCE_INFO) or b"")


def remove_recoverable_file(path: Path) -> None:
    """Remove unsaved work of a window that is gone."""
    path.unlink(missing_ok=True)
    _lock_of(path).unlink(missing_ok=True)


def write_report(folder: Path, text: str) -> None:
    """Keep the report of a problem that ended the program, in place of an earlier one."""
    make_settings_folder(folder)
    write_atomically(folder / REPORT, lambda file: file.write(text.encode()), is_private=True)


def load_report(folder: Path) -> str:
    """Return the report that was kept last; empty where there is none that can be read."""
    for name in (REPORT, SEEN_REPORT):
        with suppress(LissomError):
            content = read_file(folder / name, largest=LARGEST_REPORT)
            return content.decode(errors="replace")
    return ""


def mark_report_seen(folder: Path) -> bool:
    """Tell whether a report was kept that nobody was told of; from now on, somebody was."""
    try:
        (folder / REPORT).replace(folder / SEEN_REPORT)
    except OSError:
        return False
    return True


def remove_report(folder: Path) -> None:
    """Remove the reports that were kept."""
    for name in (REPORT, SEEN_REPORT):
        (folder / name).unlink(missing_ok=True)


def open_fault_log(folder: Path) -> int:
    """Return a descriptor of the file in which Python tells where it was when it crashed.

    Raises
    ------
    OSError
        If there cannot be one.
    """
    return os.open(folder / FAULT_LOG, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)


def read_fault_log(folder: Path) -> str:
    """Return what Python told when it crashed, and forget it; empty where it did not."""
    try:
        told = read_file(folder / FAULT_LOG, largest=LARGEST_REPORT).decode(errors="replace")
        # Other windows may have it open.
        os.truncate(folder / FAULT_LOG, 0)
    except (LissomError, OSError):
        return ""
    return told


def _parse_source_info(told: bytes) -> SourceInfo:
    """Understand where work came from; nonsense must not hide the work itself."""
    try:
        match json.loads(told):
            case {"name": str(name), "path": str(path)} if Path(path).is_absolute():
                return SourceInfo(display_name(name), Path(path))
            case {"name": str(name)}:
                return SourceInfo(display_name(name), None)
    except (ValueError, RecursionError):
        pass
    return UNKNOWN_SOURCE


def _lock_of(path: Path) -> Path:
    return path.with_suffix(".lock")
