"""Unsaved work that survives a crash: one file per running window, removed after a save.

The window holds a lock on a second file beside it. The system releases a lock however a process
ends. A process number proves nothing, because the system soon reuses the number.
"""

import hashlib
import json
import os
import secrets
import threading
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import IO, NamedTuple

from app.document import Document, Sound, SoundFile
from app.errors import LissomError, display_name
from app.storage.files.atomic import write_atomically
from app.storage.files.locks import is_locked, lock
from app.storage.files.reading import read_file
from app.storage.preferences import make_settings_folder
from app.storage.project_file import load_member, load_project, save_project

SECONDS = 20.0  # between a change and its autosave, at least
# Member with the source of unsaved work. Saved projects do not have it.
SOURCE_INFO = "origin.json"
LARGEST_SOURCE_INFO = 100_000  # bytes
# Crash reports, before and after the person was notified, and Python's own crash log.
REPORT, SEEN_REPORT, FAULT_LOG = "report.txt", "report-told.txt", "faults.txt"
LARGEST_REPORT = 1_000_000  # bytes


class SourceInfo(NamedTuple):
    """The name of unsaved work, and its project file, if there is one."""

    name: str
    path: Path | None


UNKNOWN_SOURCE = SourceInfo("recovered", None)


class Autosave:
    """The unsaved work of one window; the first write makes its folder."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / f"unsaved-{secrets.token_hex(8)}.lissom"
        self._lock: int | None = None
        self._writing = threading.Lock()

    def write(self, document: Document, origin: SourceInfo) -> None:
        """Write a document and its source, in place of an earlier autosave.

        Waits for a write of another thread, so that the last request wins.
        """
        content = json.dumps(
            {"name": origin.name, "path": origin.path and str(origin.path)}
        ).encode()
        # One file holds both, so that a crash cannot separate them.
        members = MappingProxyType({**document.unknown_members, SOURCE_INFO: content})
        with self._writing:
            self._prepare()
            self._write_sounds(document)
            # Without the bytes of sounds, which lie beside it, written once.
            sounds = _with_sound_data(document.sounds, lambda _: None)
            kept = replace(document, unknown_members=members, sounds=sounds)
            save_project(self._path, kept, is_private=True)

    def _write_sounds(self, document: Document) -> None:
        for file in {sound.file for sound in document.sounds}:
            path, data = _sound_of(self._path, file), file.data
            if data is not None and not path.exists():
                write_atomically(path, partial(_write_bytes, data=data), is_private=True)

    def remove(self) -> None:
        _remove(self._path)
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None
            _lock_of(self._path).unlink(missing_ok=True)

    def _prepare(self) -> None:
        make_settings_folder(self._path.parent)
        if self._lock is None:
            # Without locks other windows offer this work while it is still in use, which loses
            # nothing. Hidden after a crash, the work would be lost.
            with suppress(OSError):
                self._lock = os.open(_lock_of(self._path), os.O_RDWR | os.O_CREAT, 0o600)
                # Another window that searches for unsaved work holds the lock for a moment.
                while not lock(self._lock):
                    pass


def find_recoverable_files(folder: Path) -> list[Path]:
    """Return the autosave files of windows that no longer run, the newest first."""
    found = {}
    for path in folder.glob("unsaved-*.lissom"):
        if not is_locked(_lock_of(path)):
            with suppress(OSError):  # another window has just removed it
                found[path] = path.stat().st_mtime
    return sorted(found, key=lambda path: found[path], reverse=True)


def load_recoverable_file(path: Path) -> tuple[Document, SourceInfo]:
    """Read unsaved work and its source."""
    document = load_project(path)
    attachments = dict(document.unknown_members)
    origin = _parse_source_info(attachments.pop(SOURCE_INFO, b""))
    members = MappingProxyType(attachments)
    sounds = _with_sound_data(document.sounds, partial(_read_sound, path))
    return replace(document, unknown_members=members, sounds=sounds), origin


def read_source_info(path: Path) -> SourceInfo:
    """Return the source of unsaved work, without reading the work itself."""
    return _parse_source_info(load_member(path, SOURCE_INFO, LARGEST_SOURCE_INFO) or b"")


def remove_recoverable_file(path: Path) -> None:
    """Remove the autosave of a window that no longer runs."""
    _remove(path)
    _lock_of(path).unlink(missing_ok=True)


def write_report(folder: Path, text: str) -> None:
    """Write the report of a problem that ended the program, in place of an earlier report."""
    make_settings_folder(folder)
    write_atomically(folder / REPORT, lambda file: file.write(text.encode()), is_private=True)


def load_report(folder: Path) -> str:
    """Return the last report; empty if no report can be read."""
    for name in (REPORT, SEEN_REPORT):
        with suppress(LissomError):
            content = read_file(folder / name, largest=LARGEST_REPORT)
            return content.decode(errors="replace")
    return ""


def mark_report_seen(folder: Path) -> bool:
    """Return whether there was an unseen report, and mark the report as seen."""
    try:
        (folder / REPORT).replace(folder / SEEN_REPORT)
    except OSError:
        return False
    return True


def remove_report(folder: Path) -> None:
    for name in (REPORT, SEEN_REPORT):
        (folder / name).unlink(missing_ok=True)


def open_fault_log(folder: Path) -> int:
    """Return a descriptor of the file into which Python writes its traceback at a crash.

    Raises `OSError` if the file cannot be opened.
    """
    return os.open(folder / FAULT_LOG, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)


def read_fault_log(folder: Path) -> str:
    """Return Python's traceback of a crash and empty the log; empty if there was no crash."""
    try:
        content = read_file(folder / FAULT_LOG, largest=LARGEST_REPORT).decode(errors="replace")
        # Other windows may have the file open.
        os.truncate(folder / FAULT_LOG, 0)
    except (LissomError, OSError):
        return ""
    return content


def _parse_source_info(content: bytes) -> SourceInfo:
    """Parse the source of unsaved work. An unreadable source must not hide the work itself."""
    try:
        match json.loads(content):
            case {"name": str(name), "path": str(path)} if Path(path).is_absolute():
                return SourceInfo(display_name(name), Path(path))
            case {"name": str(name)}:
                return SourceInfo(display_name(name), None)
    except (ValueError, RecursionError):
        pass
    return UNKNOWN_SOURCE


def _with_sound_data(
    sounds: Iterable[Sound], find: Callable[[SoundFile], bytes | None]
) -> tuple[Sound, ...]:
    """Return sounds with the bytes that a function finds for their files."""
    return tuple(replace(each, file=replace(each.file, data=find(each.file))) for each in sounds)


def _read_sound(path: Path, file: SoundFile) -> bytes | None:
    """Return the bytes of a sound beside an autosave; None if they are missing."""
    with suppress(LissomError):
        data = read_file(_sound_of(path, file))
        return data if hashlib.sha256(data).hexdigest() == file.sha256 else None
    return None


def _write_bytes(file: IO[bytes], data: bytes) -> None:
    file.write(data)


def _sound_of(path: Path, file: SoundFile) -> Path:
    return path.with_suffix(f".{file.sha256}.sound")


def _remove(path: Path) -> None:
    """Remove an autosave with its sounds."""
    for each in (path, *path.parent.glob(f"{path.stem}.*.sound")):
        each.unlink(missing_ok=True)


def _lock_of(path: Path) -> Path:
    return path.with_suffix(".lock")
