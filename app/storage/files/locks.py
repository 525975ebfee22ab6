"""Locks on open files. The system releases them however a process ends.

A process number proves nothing, because the system soon reuses the number.
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

# The system's errors for a held lock. Other errors mean that the disk has no locks.
LOCK_HELD_ERRORS = (BlockingIOError, PermissionError)
# Follow no link, and wait for no writer of a pipe.
PLAIN = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
# The byte that is locked on Windows. Other processes cannot read a locked byte, so it is the last
# possible byte, behind all contents.
LOCKED_BYTE = 2**31 - 2


def open_to_lock(path: Path, flags: int = 0) -> int:
    """Return a descriptor of a file to lock; a read-only file is opened for reading.

    Raises `OSError` if the file is missing or unreadable.
    """
    try:
        return os.open(path, os.O_RDWR | PLAIN | flags, 0o666)
    except PermissionError:
        return os.open(path, os.O_RDONLY | PLAIN)


def lock(descriptor: int) -> bool:
    """Lock an open file until it is closed; return False if another process holds a lock.

    Raises `OSError` if the disk has no locks.
    """
    try:
        if sys.platform == "win32":
            with at_lock_byte(descriptor):
                msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        else:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except LOCK_HELD_ERRORS:
        return False
    return True


@contextmanager
def at_lock_byte(descriptor: int) -> Iterator[None]:
    """Seek to the lock byte of an open file, and back after the `with` block."""
    place = os.lseek(descriptor, 0, os.SEEK_CUR)
    os.lseek(descriptor, LOCKED_BYTE, os.SEEK_SET)
    try:
        yield
    finally:
        os.lseek(descriptor, place, os.SEEK_SET)


def is_locked(path: Path) -> bool:
    """Return whether a process holds a lock on a file; False if there is no file or no locks."""
    try:
        descriptor = open_to_lock(path)
    except OSError:
        return False
    try:
        return not lock(descriptor)
    except OSError:
        return False
    finally:
        os.close(descriptor)
