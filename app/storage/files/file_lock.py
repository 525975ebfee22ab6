"""A lock that shows other windows that a file is in use: a locked file beside it, with a name."""

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
from app.texts import _

TRIES = 100
LARGEST_LOCK_TEXT = 1000  # bytes in the lock file


class FileLockedError(LissomError):
    """Another process holds the file. The message names the holder and the time."""


class FileLock:
    """A lock on a file for this process, until it is released or the process ends.

    Parameters
    ----------
    path : Path
        Need not exist, but its folder must.

    Raises
    ------
    FileLockedError
        If another process holds the lock.
    OSError
        If the folder is not writable, or its disk has no locks.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        target = Path(os.path.realpath(path))
        # The length is the same for every file name.
        number = hashlib.sha256(os.fsencode(target.name)).hexdigest()[:16]
        self._lock_path = target.with_name(f".lissom-{number}.lock")
        self._descriptor = self._acquire()
        content = json.dumps({"who": _name_holder(), "since": time.time()}).encode()
        with suppress(OSError):  # on a full disk the lock works without a name in it
            os.ftruncate(self._descriptor, 0)
            os.write(self._descriptor, content)

    def release(self) -> None:
        if sys.platform == "win32":
            # Windows cannot remove an open file.
            os.close(self._descriptor)
        with suppress(OSError):
            self._lock_path.unlink()
        if sys.platform != "win32":
            os.close(self._descriptor)

    def _acquire(self) -> int:
        for _try in range(TRIES):
            descriptor = open_to_lock(self._lock_path, os.O_CREAT)
            try:
                is_ours = lock(descriptor)
                # The previous holder may have removed the file by now; nobody would see this lock.
                if is_ours and os.path.samestat(os.fstat(descriptor), self._lock_path.stat()):
                    return descriptor
                content = os.read(descriptor, LARGEST_LOCK_TEXT) if not is_ours else b""
            except FileNotFoundError:
                is_ours, content = True, b""
            except OSError:
                os.close(descriptor)
                raise
            os.close(descriptor)
            if not is_ours:
                raise FileLockedError(_parse_holder(content))
        raise OSError(_("another program keeps removing the lock file"))


def _name_holder() -> str:
    try:
        name = getpass.getuser()
    except (OSError, KeyError, ImportError):
        name = "somebody"
    return f"{name} on {platform.node() or 'this machine'}"


def _parse_holder(content: bytes) -> str:
    """Parse the contents of a lock file. Unreadable contents give only certain facts."""
    try:
        match json.loads(content):
            case {"who": str(who), "since": float(since)} if who.isprintable():
                at = time.strftime("%Y-%m-%d %H:%M", time.localtime(since))
                return _("by {name}, since {time}").format(name=who[:100], time=at)
    except (ValueError, RecursionError, OverflowError, OSError):
        pass
    return _("in another window")
