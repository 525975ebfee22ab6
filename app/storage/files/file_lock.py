"""Telling other windows that a file is worked on: a locked file beside it, with a name in it."""

import getpass
import hashlib
import json
import os
import platform
import sys
import time
from contextlib import suppress
from pathlib import Path

from app.errors import LissomError
from app.storage.files.locks import lock, open_to_lock

TRIES = 100
LARGEST_LOCK_TEXT = 1000  # bytes, of what stands in the file


class FileLockedError(LissomError):
    """Somebody else holds the file; the message tells who and since when."""


class FileLock:
    """A lock that shows others that this process works on a file, until it is released or ends.

    Parameters
    ----------
    path : Path
        It need not exist; its folder does.

    Raises
    ------
    FileLockedError
        If somebody else holds it.
    OSError
        If the folder may not be written to, or its disk knows no locks.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        target = Path(os.path.realpath(path))
        # Of one length, however long the name is.
        number = hashlib.sha256(os.fsencode(target.name)).hexdigest()[:16]
        self._lock_path = target.with_name(f".lissom-{number}.lock")
        self._descriptor = self._acquire()
        told = json.dumps({"who": _name_holder(), "since": time.time()}).encode()
        with suppress(OSError):  # it holds without its name, on a full disk too
            os.ftruncate(self._descriptor, 0)
            os.write(self._descriptor, told)

    def release(self) -> None:
        """Let others work on the file."""
        if sys.platform == "win32":
            # What is open cannot be removed there.
            os.close(self._descriptor)
        with suppress(OSError):
            self._lock_path.unlink()
        if sys.platform != "win32":
            os.close(self._descriptor)

    def _acquire(self) -> int:
        for _ in range(TRIES):
            descriptor = open_to_lock(self._lock_path, os.O_CREAT)
            try:
                is_ours = lock(descriptor)
                # Whoever held it before may have removed it by now: it is nobody's then.
                if is_ours and os.path.samestat(os.fstat(descriptor), self._lock_path.stat()):
                    return descriptor
                told = os.read(descriptor, LARGEST_LOCK_TEXT) if not is_ours else b""
            except FileNotFoundError:
                is_ours, told = True, b""
            except OSError:
                os.close(descriptor)
                raise
            os.close(descriptor)
            if not is_ours:
                raise FileLockedError(_parse_holder(told))
        raise OSError("the lock file is removed again and again")


def _name_holder() -> str:
    try:
        name = getpass.getuser()
    except (OSError, KeyError, ImportError):
        name = "somebody"
    return f"{name} on {platform.node() or 'this machine'}"


def _parse_holder(told: bytes) -> str:
    """Understand what stands in a lock file; nonsense is told as what is known for sure."""
    try:
        match json.loads(told):
            case {"who": str(who), "since": float(since)} if who.isprintable():
                at = time.strftime("%Y-%m-%d %H:%M", time.localtime(since))
                return f"by {who[:100]}, since {at}"
    except (ValueError, RecursionError, OverflowError, OSError):
        pass
    return "in another window"
