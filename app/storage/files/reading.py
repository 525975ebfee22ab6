"""Reading whole files, within limits of size."""

import hashlib
import os
import stat
import struct
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, NamedTuple

from app.errors import LissomError
from app.texts import N_, _

MEBIBYTE = 1024 * 1024
LARGEST_FILE = 1024 * MEBIBYTE
TAIL = 1 * MEBIBYTE
AT_ONCE = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
# Limit of the growth of all members of a zip file by unpacking. Pictures are packed already; the
# limit concerns arrays and JSON. The largest meshes take 60 MiB.
MOST_UNPACKED = 256 * MEBIBYTE
METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
# Exceptions of zipfile on damaged files. The first two mean encryption and an unknown method.
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
FOLDER_READ = N_("cannot read {path}: it is a folder")
NOT_ORDINARY = N_(
    "cannot read {path}: it is not an ordinary file; copy its content into an ordinary file"
)


class OpenFile(NamedTuple):
    """A file that is open for reading, and its size in bytes."""

    stream: IO[bytes]
    size: int


@contextmanager
def open_file(path: Path) -> Iterator[OpenFile]:
    """Open a file for reading. All files that people name are opened here.

    Raises
    ------
    LissomError
        If the path is not a plain file: a pipe or a device may be endless.
    OSError
        If the file cannot be opened.
    """
    # Do not wait for the writer of a pipe. The checked file is the file that is read.
    descriptor = os.open(path, os.O_RDONLY | AT_ONCE)
    status = os.fstat(descriptor)
    if not stat.S_ISREG(status.st_mode):
        os.close(descriptor)
        if stat.S_ISDIR(status.st_mode):
            raise LissomError(_(FOLDER_READ).format(path=path))
        raise LissomError(_(NOT_ORDINARY).format(path=path))
    with os.fdopen(descriptor, "rb") as stream:
        yield OpenFile(stream, status.st_size)


@contextmanager
def open_zip(file: IO[bytes]) -> Iterator[zipfile.ZipFile]:
    """Open a zip file whose members use the common packing methods.

    Raises `NotImplementedError` if a member uses another method: the decoders of other methods
    ignore size limits and raise other errors. As every exception in `DAMAGED_ZIP`, it may also come
    of any damaged file.
    """
    with zipfile.ZipFile(file) as archive:
        if not {member.compress_type for member in archive.infolist()} <= METHODS:
            raise NotImplementedError
        yield archive


def file_time(path: Path) -> int:
    """Return when a file was changed, in nanoseconds; 0 if there is no file."""
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


def tail_digest(file: IO[bytes]) -> str:
    """Return a digest of the size and the end of a zip file, which identifies its contents.

    The end holds the table of contents with a checksum of each member. The modification time proves
    nothing: files are copied, and clocks jump.
    """
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - TAIL))
    return f"{size}-{hashlib.sha256(file.read()).hexdigest()}"


def read_file(path: Path, *, largest: int = LARGEST_FILE) -> bytes:
    """Return the bytes of a file.

    Raises `LissomError` if the file is missing, unreadable, no plain file, or larger than `largest`
    bytes.
    """
    try:
        with open_file(path) as (file, size):
            if size <= largest:
                return file.read(size)
    except OSError as error:
        raise LissomError(
            _("cannot read {path}: {reason}").format(path=path, reason=error.strerror or error)
        ) from error
    except ValueError as error:  # no file can have this name
        raise LissomError(
            _("cannot read {path}: {reason}").format(path=path, reason=error)
        ) from error
    raise LissomError(
        _("cannot read {path}: it has {size:,} bytes, and Lissom reads at most {largest:,}").format(
            path=path, size=size, largest=largest
        )
    )
