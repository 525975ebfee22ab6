"""Writing files so that the person's work is never half there.

What is written is in a hidden file beside its place first, and locked as long as it is written: one
that nobody holds was left by a process that was killed, and is removed by the next that comes.
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

T = TypeVar("T")
NEW_FILE = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
PRIVATE = 0o600
PART = re.compile(r"\.lissom-[0-9a-f]{16}\.part(\.png)?")
# What the system says where there is no room: on the disk, for this person, in one file.
NO_ROOM = {errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)}
NOT_ALLOWED = {errno.EACCES, errno.EPERM, errno.EROFS}


class DiskFullError(LissomError):
    """There is no room for a file; the message tells how much it takes and how much is free.

    Parameters
    ----------
    cause : OSError
        What the system says.
    needed : int
        Bytes, as far as is known.
    is_whole : bool
        Whether that is all that it takes.
    """

    def __init__(self, path: Path, cause: OSError, needed: int, *, is_whole: bool = False) -> None:
        self.cause = cause
        more, free = "" if is_whole else " or more", ""
        with suppress(OSError):
            room = shutil.disk_usage(os.path.realpath(path.parent)).free
            # Where it is the disk that is full, and not what this person may have of it.
            free = f", and {_size(room)} are free there" if cause.errno == errno.ENOSPC else ""
        super().__init__(
            f"cannot write {path}: {cause.strerror}: it takes {_size(needed)}{more}{free}; make "
            "room or choose another folder"
        )


def _size(count: int) -> str:
    return f"{count / 1e6:,.1f} MB" if count >= 1e6 else f"{count / 1e3:,.1f} KB"


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
        Used exactly as given; an existing file is replaced. Of a link, that is what it points to.
    write : callable
        Writes the contents to the open binary file that it is handed, which can be read as well.
    cancellation : Cancellation, optional
        By which it can be cancelled before the file takes its place; that is a `LissomError`.
    is_private : bool
        Whether nobody else may read it.

    Returns
    -------
    object
        What `write` returns.

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

    Parameters
    ----------
    path, cancellation
        As in `write_atomically`.

    Raises
    ------
    LissomError
        As `write_atomically`; an `OSError` of the block counts as the disk's refusal.
    """
    with atomic_files(path, cancellation=cancellation) as (file,):
        yield file


@contextmanager
def atomic_files(
    *paths: Path, cancellation: Cancellation | None = None, is_private: bool = False
) -> Iterator[list[IO[bytes]]]:
    """Open files that take their places together, as `atomic_file`: all of them or none.

    Whoever ends the process between leaves all but the first out, so that what is there is of one
    time.
    """
    check_writable(*paths)
    parts, modes, files = list[Path](), list[int | None](), list[IO[bytes]]()
    targets = [Path(os.path.realpath(path)) for path in paths]
    try:
        with ExitStack() as opened:
            for target in targets:
                _clear_once(target.parent)
                # The file that is replaced hands on its permissions. Those of a new one are the
                # system's affair: to ask for the umask would change it for all threads.
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
                # As long as they are locked: else another process may take them for abandoned.
                _take_places(parts, targets)
        if sys.platform == "win32":
            # What is open cannot be moved there.
            _take_places(parts, targets)
    except OSError as error:
        raise _refusal(paths[0], error, parts) from error
    finally:
        for part in parts:
            part.unlink(missing_ok=True)


def remove_abandoned_files(folder: Path) -> None:
    """Remove the files in a folder that killed processes left half written.

    What another process still writes stays, and so does all where the disk knows no locks.
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
    """Return a new name for a picture in a folder that is soon removed.

    If it is not, the next start removes it, like files half written, unless it is locked.
    """
    return folder / f"{_part_name()}.png"


def sync_folder(folder: Path) -> None:
    """Let the disk note what a folder holds now, so that a new file is there if power fails."""
    with suppress(OSError):  # not every system can
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


@cache
def _clear_once(folder: Path) -> None:
    """Clear a folder when this process writes there first: an export has thousands of files."""
    remove_abandoned_files(folder)


def _remove_abandoned(part: Path) -> None:
    if sys.platform == "win32":
        # What another process has open cannot be removed there.
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
        with suppress(OSError):  # without locks nobody removes it
            if not lock(descriptor) or not os.fstat(descriptor).st_nlink:
                # Another process came between, and took it for abandoned.
                os.close(descriptor)
                continue
        return part, descriptor


def _part_name() -> str:
    return f".lissom-{secrets.token_hex(8)}.part"


def _take_places(parts: Sequence[Path], targets: Sequence[Path]) -> None:
    """Move files to their places; what is there of all but the first gives way before it."""
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
    """Say in words that the system refuses to write a file, and what to do."""
    reason = error.strerror or str(error)
    if error.errno in NO_ROOM:
        written = sum(part.stat().st_size for part in parts)
        return DiskFullError(path, error, written)
    if error.errno in NOT_ALLOWED:
        reason += f": its folder {path.parent} may not be written to; choose another one"
    return LissomError(f"cannot write {path}: {reason}")
