"""Locks on open files, which the system lets go of however a process ends.

A process's number is soon given to another one, and proves nothing.
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

# What the system says of a lock that is held; other errors mean that it knows no locks there.
LOCK_HELD_ERRORS = (BlockingIOError, PermissionError)
# Not through a link that somebody else put there, and not until somebody writes to a pipe.
PLAIN = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
# The byte that is locked on Windows, the last one that can be: nobody else may read it there, and
# what stands in a file is to be read.
LOCKED_BYTE = 2**31 - 2


def open_to_lock(path: Path, flags: int = 0) -> int:
    """Return a file that is opened to be locked, be it only to be read.

    Raises
    ------
    OSError
        If it is not there, or may not even be read.
    """
    try:
        return os.open(path, os.O_RDWR | PLAIN | flags, 0o666)
    except PermissionError:
        return os.open(path, os.O_RDONLY | PLAIN)


def lock(descriptor: int) -> bool:
    """Lock an open file until it is closed, unless somebody else holds it; return whether it is.

    Raises
    ------
    OSError
        If the disk knows no locks.
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
    """Go to the byte of an open file that is locked, and back again after the `with` block."""
    place = os.lseek(descriptor, 0, os.SEEK_CUR)
    os.lseek(descriptor, LOCKED_BYTE, os.SEEK_SET)
    try:
        yield
    finally:
        os.lseek(descriptor, place, os.SEEK_SET)


def is_locked(path: Path) -> bool:
    """Tell whether somebody holds a lock on a file; not so where there is none, or no locks."""
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
