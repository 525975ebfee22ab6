"""Reading whole files, which are neither endless nor larger than memory."""

import hashlib
import os
import stat
import struct
import zipfile
import zlib
from pathlib import Path
from typing import IO

from app.errors import LissomError

MEBIBYTE = 1024 * 1024
LARGEST_FILE = 1024 * MEBIBYTE
TAIL = 1 * MEBIBYTE
# What zipfile raises on damaged files; the first two are encryption and a method that is not known.
DAMAGED_ZIP = (
    RuntimeError,
    NotImplementedError,
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    KeyError,
    ValueError,
    OverflowError,
)


def require_file(path: Path) -> int:
    """Return the size of a file in bytes.

    Raises
    ------
    LissomError
        If it is something else, such as a pipe or a device, which may never end.
    OSError
        If it cannot be looked at.
    """
    status = path.stat()
    if stat.S_ISDIR(status.st_mode):
        raise LissomError(f"cannot read {path}: it is a folder")
    if not stat.S_ISREG(status.st_mode):
        raise LissomError(f"cannot read {path}: it is not an ordinary file; copy it into one")
    return status.st_size


def tail_digest(file: IO[bytes]) -> str:
    """Return what tells the contents of a zip file from others: its size and its end.

    Its table of contents is there, with a checksum of each member. When it was written proves
    nothing: it may have been copied, and clocks jump.
    """
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - TAIL))
    return f"{size}-{hashlib.sha256(file.read()).hexdigest()}"


def read_file(path: Path, *, largest: int = LARGEST_FILE) -> bytes:
    """Return the bytes of a file.

    Raises
    ------
    LissomError
        If the file is missing, unreadable, no ordinary file, or larger than `largest` bytes.
    """
    try:
        size = require_file(path)
        if size > largest:
            raise LissomError(
                f"cannot read {path}: it has {size:,} bytes, more than the {largest:,} that "
                "Lissom reads"
            )
        return path.read_bytes()
    except OSError as error:
        raise LissomError(f"cannot read {path}: {error.strerror or error}") from error
    except ValueError as error:  # of names that no file can have
        raise LissomError(f"cannot read {path}: {error}") from error
