"""The contents of a folder, for the built-in file browser."""

import os
import time
from dataclasses import dataclass
from pathlib import Path

from app.texts import _

UNITS = (_("bytes"), _("kB"), _("MB"), _("GB"))


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A folder or a file; size in bytes, time in seconds since 1970."""

    path: Path
    is_folder: bool
    size: int
    changed: float

    @property
    def size_in_words(self) -> str:
        """The size as text; empty for a folder."""
        if self.is_folder:
            return ""
        power = 0
        while self.size >= 1000 ** (power + 1) and power < len(UNITS) - 1:
            power += 1
        size = self.size / 1000**power
        return f"{size:.{1 if power and size < 10 else 0}f} {UNITS[power]}"

    @property
    def changed_in_words(self) -> str:
        """Local day and minute of the last change. Empty if the calendar cannot express it."""
        try:
            return time.strftime("%Y-%m-%d  %H:%M", time.localtime(self.changed))
        except (OverflowError, ValueError, OSError):
            return ""  # the clock was wrong


@dataclass(frozen=True, slots=True, kw_only=True)
class Listing:
    """The entries of a folder, or the reason why it cannot be read."""

    folder: Path
    suffixes: tuple[str, ...]  # of the listed files
    version: tuple[int, ...]  # changes whenever the folder changes
    entries: tuple[Entry, ...] = ()
    problem: str = ""  # empty if there is none

    def is_current(self, folder: Path, suffixes: tuple[str, ...]) -> bool:
        """Return whether reading the folder again would give the same listing."""
        return (folder, suffixes, _version(folder)) == (self.folder, self.suffixes, self.version)


def read_folder(folder: Path, suffixes: tuple[str, ...]) -> Listing:
    """List the visible folders, and the visible files with these suffixes."""
    version = _version(folder)
    try:
        with os.scandir(folder) as found:
            visible = [_entry(entry) for entry in found if not entry.name.startswith(".")]
    except OSError as error:
        problem = _("This folder cannot be read: {reason}").format(reason=error.strerror or error)
        return Listing(folder=folder, suffixes=suffixes, version=version, problem=problem)
    entries = tuple(
        entry
        for entry in visible
        if entry and (entry.is_folder or entry.path.suffix.lower() in suffixes)
    )
    return Listing(folder=folder, suffixes=suffixes, version=version, entries=entries)


def _entry(found: os.DirEntry[str]) -> Entry | None:
    """Return the list's entry of a file or a folder, or None if its status cannot be read."""
    try:
        status = found.stat()
        is_folder = found.is_dir()
    except OSError:
        return None
    return Entry(
        path=Path(found.path), is_folder=is_folder, size=status.st_size, changed=status.st_mtime
    )


def _version(folder: Path) -> tuple[int, ...]:
    try:
        status = folder.stat()
    except OSError:
        return ()
    # The second time changes with the read permission.
    return status.st_mtime_ns, status.st_ctime_ns
