"""Reading whole files, which are neither endless nor larger than memory."""

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

MEBIBYTE = 1024 * 1024
LARGEST_FILE = 1024 * MEBIBYTE
TAIL = 1 * MEBIBYTE
AT_ONCE = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
# By which all members of a zip file together may outgrow it. Pictures are packed already, so that
# this is for arrays and JSON; the largest meshes take 60.
MOST_UNPACKED = 256 * MEBIBYTE
METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
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
FOLDER_READ = "cannot read {path}: it is a folder"
NOT_ORDINARY = "cannot read {path}: it is not an ordinary file; copy it into one"


class OpenFile(NamedTuple):
    """A file that is open for reading, and its size in bytes."""

    stream: IO[bytes]
    size: int


@contextmanager
def open_file(path: Path) -> Iterator[OpenFile]:
    """Lend a file for reading: the one door through which files that people name come in.

    Raises
    ------
    LissomError
        If it is something else, such as a pipe or a device, which may never end.
    OSError
        If it cannot be opened.
    """
    # Nobody waits until somebody writes to a pipe, and what is looked at is what is read.
    descriptor = os.open(path, os.O_RDONLY | AT_ONCE)
    status = os.fstat(descriptor)
    if not stat.S_ISREG(status.st_mode):
        os.close(descriptor)
        if stat.S_ISDIR(status.st_mode):
            raise LissomError(FOLDER_READ.format(path=path))
        raise LissomError(NOT_ORDINARY.format(path=path))
    with os.fdopen(descriptor, "rb") as stream:
        yield OpenFile(stream, status.st_size)


@contextmanager
def open_zip(file: IO[bytes]) -> Iterator[zipfile.ZipFile]:
    """Open a zip file whose members are packed as nearly all are.

    Raises
    ------
    NotImplementedError
        If one is packed otherwise: what else there is unpacks more than it is asked for, and fails
        in ways of its own. As all of `DAMAGED_ZIP`, it may come of any damaged file.
    """
    with zipfile.ZipFile(file) as archive:
        if not {member.compress_type for member in archive.infolist()} <= METHODS:
            raise NotImplementedError
        yield archive


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
        with open_file(path) as (file, size):
            if size <= largest:
                return file.read(size)
    except OSError as error:
        raise LissomError(f"cannot read {path}: {error.strerror or error}") from error
    except ValueError as error:  # of names that no file can have
        raise LissomError(f"cannot read {path}: {error}") from error
    raise LissomError(
        f"cannot read {path}: it has {size:,} bytes, more than the {largest:,} that Lissom reads"
    )
