"""Atomic writing of files: the person's work is never half written.

Contents first go to a hidden file beside the target. The hidden file is locked while it is written.
A hidden file without a lock was left by a killed process; the next write in its folder removes it.
"""

import errno
import io
import os
import re
import secrets
import shutil
import stat
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import IO, TypeVar

from app.errors import LissomError
from app.storage.files.cancellation import Cancellation
from app.storage.files.locks import lock, open_to_lock
from app.storage.files.outputs import check_writable
from app.texts import _

T = TypeVar("T")
NEW_FILE = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
PRIVATE = 0o600
PART = re.compile(r"\.lissom-[0-9a-f]{16}\.part(\.png)?")
# The system's error numbers for no room: on the disk, in the person's quota, in one file.
NO_ROOM = {errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)}
NOT_ALLOWED = {errno.EACCES, errno.EPERM, errno.EROFS}


class DiskFullError(LissomError):
    """The disk has no room for a file. The message states the needed and the free bytes.

    `needed` is in bytes, as far as is known; `is_whole` means that it counts the whole file.
    """

    def __init__(self, path: Path, cause: OSError, needed: int, *, is_whole: bool = False) -> None:
        self.cause = cause
        size = _size(needed) if is_whole else _("{size} or more").format(size=_size(needed))
        with suppress(OSError):
            room = shutil.disk_usage(os.path.realpath(path.parent)).free
            # Only if the disk is full, and not the person's quota.
            if cause.errno == errno.ENOSPC:
                size = _("{size}, but only {free} are free there").format(
                    size=size, free=_size(room)
                )
        super().__init__(
            _(
                "cannot write {path}: {reason}. The file needs {size}; free some space, or "
                "choose another folder"
            ).format(path=path, reason=cause.strerror, size=size)
        )


def _size(count: int) -> str:
    if count < 1e6:
        return _("{count:,.1f} KB").format(count=count / 1e3)
    return _("{count:,.1f} MB").format(count=count / 1e6)


def write_atomically(
    path: Path,
    write: Callable[[IO[bytes]], T],
    cancellation: Cancellation | None = None,
    *,
    is_private: bool = False,
) -> T:
    """Write a file so that at any moment the old or the new one is whole.

    Parameters
    ----------
    path : Path
        Used exactly as given; an existing file is replaced. A link stays, and its target is
        replaced.
    write : callable
        Writes the contents to the given binary file, which is also readable.
    cancellation : Cancellation, optional
        Cancels the write before the file takes its place, with a `LissomError`.
    is_private : bool
        Whether only the person may read the file.

    Returns
    -------
    object
        The result of `write`.

    Raises
    ------
    LissomError
        As `check_writable`, or if the disk refuses.
    """
    try:
        with atomic_files(path, cancellation=cancellation, is_private=is_private) as (file,):
            return write(file)
    except DiskFullError as error:
        with suppress(OSError):
            whole = io.BytesIO()
            write(whole)
            needed = len(whole.getbuffer())
            raise DiskFullError(path, error.cause, needed, is_whole=True) from error
        raise


@contextmanager
def atomic_file(path: Path, cancellation: Cancellation | None = None) -> Iterator[IO[bytes]]:
    """Open a file that takes the place of `path` when the `with` block ends without an error.

    Raises `LissomError` as `write_atomically`. An `OSError` in the block counts as a refusal of the
    disk.
    """
    with atomic_files(path, cancellation=cancellation) as (file,):
        yield file


@contextmanager
def atomic_files(
    *paths: Path, cancellation: Cancellation | None = None, is_private: bool = False
) -> Iterator[list[IO[bytes]]]:
    """Open files that take their places together, as `atomic_file`: all of them or none.

    If the process ends between two replacements, only the first file exists. Files of different
    times never mix.
    """
    check_writable(*paths)
    parts, modes, files = list[Path](), list[int | None](), list[IO[bytes]]()
    targets = [Path(os.path.realpath(path)) for path in paths]
    try:
        with ExitStack() as opened:
            for target in targets:
                _clear_once(target.parent)
                # A replaced file keeps its permissions. The system decides those of a new file:
                # reading the umask would change the umask for all threads.
                mode = stat.S_IMODE(target.stat().st_mode) if target.exists() else None
                mode = PRIVATE if is_private else mode
                part, descriptor = _new_part(target.parent, 0o666 if mode is None else PRIVATE)
                parts.append(part)
                modes.append(mode)
                files.append(opened.enter_context(os.fdopen(descriptor, "w+b")))
                if cancellation is not None:
                    cancellation.add_part(part)
            yield files
            for file in files:
                file.flush()
                os.fsync(file.fileno())
            if cancellation is not None:
                cancellation.commit()
            for part, mode in zip(parts, modes, strict=True):
                if mode is not None:
                    part.chmod(mode)
            if sys.platform != "win32":
                # Keep the locks until the files are in place: another process would remove unlocked
                # files.
                _take_places(parts, targets)
        if sys.platform == "win32":
            # Windows cannot move an open file.
            _take_places(parts, targets)
    except OSError as error:
        raise _refusal(paths[0], error, parts) from error
    finally:
        for part in parts:
            part.unlink(missing_ok=True)


def remove_abandoned_files(folder: Path) -> None:
    """Remove the half-written files of killed processes from a folder.

    Files that another process still writes stay. On a disk without locks all files stay.
    """
    try:
        with os.scandir(folder) as found:
            parts = [Path(entry.path) for entry in found if PART.fullmatch(entry.name)]
    except OSError:
        return
    for part in parts:
        with suppress(OSError):
            _remove_abandoned(part)


def temporary_picture(folder: Path) -> Path:
    """Return a new name for a short-lived picture in a folder.

    If the picture remains, the next start removes it like half-written files, unless it is locked.
    """
    return folder / f"{_part_name()}.png"


def sync_folder(folder: Path) -> None:
    """Flush a folder to the disk, so that a new file survives a power failure."""
    with suppress(OSError):  # not every system supports this
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


@cache
def _clear_once(folder: Path) -> None:
    """Clear a folder at this process's first write there only: an export has thousands of files."""
    remove_abandoned_files(folder)


def _remove_abandoned(part: Path) -> None:
    if sys.platform == "win32":
        # Windows cannot remove a file that another process has open.
        part.unlink()
        return
    descriptor = open_to_lock(part)
    try:
        if lock(descriptor):
            part.unlink()
    finally:
        os.close(descriptor)


def _new_part(folder: Path, mode: int) -> tuple[Path, int]:
    """Return a new hidden file, open for writing and locked."""
    while True:
        part = folder / _part_name()
        descriptor = os.open(part, NEW_FILE, mode)
        with suppress(OSError):  # a file without a lock is never removed as abandoned
            if not lock(descriptor) or not os.fstat(descriptor).st_nlink:
                # Another process took the file for abandoned and removed it.
                os.close(descriptor)
                continue
        return part, descriptor


def _part_name() -> str:
    return f".lissom-{secrets.token_hex(8)}.part"


def _take_places(parts: Sequence[Path], targets: Sequence[Path]) -> None:
    """Move files to their places. The old files of all but the first are removed before that."""
    aside = {}
    try:
        for target in targets[1:]:
            if target.exists():
                hidden = target.with_name(_part_name())
                target.replace(hidden)
                aside[target] = hidden
        parts[0].replace(targets[0])
    except OSError:
        for target, hidden in aside.items():
            hidden.replace(target)
        raise
    for part, target in zip(parts[1:], targets[1:], strict=True):
        part.replace(target)
    for hidden in aside.values():
        hidden.unlink()


def _refusal(path: Path, error: OSError, parts: Sequence[Path]) -> LissomError:
    """Return an error that states the system's refusal to write a file and the remedy."""
    reason = error.strerror or str(error)
    if error.errno in NO_ROOM:
        written = sum(part.stat().st_size for part in parts)
        return DiskFullError(path, error, written)
    if error.errno in NOT_ALLOWED:
        reason = _(
            "{reason}: you have no permission to write to its folder {folder}; choose another "
            "folder"
        ).format(reason=reason, folder=path.parent)
    return LissomError(_("cannot write {path}: {reason}").format(path=path, reason=reason))
