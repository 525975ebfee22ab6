"""Named arrays as NPZ files."""

import math
import tokenize
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from app.errors import LissomError
from app.storage.files.atomic import write_atomically
from app.storage.files.reading import DAMAGED_ZIP, MOST_UNPACKED, open_file, open_zip
from app.texts import N_, _

HEADERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
TEXT = "US"  # NumPy's letters for kinds of arrays
NUMERIC = "biufc"
NO_ARRAYS = N_("{path} is not an NPZ file of numeric arrays, or is damaged")
# Further exceptions that NumPy raises on damaged files.
DAMAGE = (*DAMAGED_ZIP, SyntaxError, TypeError, tokenize.TokenError)


def write_arrays(path: Path, arrays: Mapping[str, npt.ArrayLike]) -> None:
    """Write named arrays as an NPZ file, atomically and under exactly this name."""
    contents: dict[str, Any] = {name: np.asarray(values) for name, values in arrays.items()}
    write_atomically(path, lambda file: np.savez(file, **contents))


def read_arrays(
    path: Path, *, required: tuple[str, ...], optional: tuple[str, ...] = ()
) -> dict[str, npt.NDArray[Any]]:
    """Read the required arrays and all present optional arrays from an NPZ file.

    Raises `LissomError` if the file is missing, is not an NPZ file, is damaged, would unpack to too
    much, or lacks a required array.
    """
    try:
        with open_file(path) as (file, size), open_zip(file) as archive:
            members = _members(archive, path, size, required, optional)
            return {name: _read_array(archive, member) for name, member in members.items()}
    except OSError as error:
        raise LissomError(
            _("cannot read {path}: {reason}").format(path=path, reason=error.strerror or error)
        ) from error
    except DAMAGE as error:
        raise LissomError(_(NO_ARRAYS).format(path=path)) from error


def _members(
    archive: zipfile.ZipFile,
    path: Path,
    size: int,
    required: tuple[str, ...],
    optional: tuple[str, ...],
) -> dict[str, zipfile.ZipInfo]:
    """Return the requested members by the names of their arrays."""
    members = {member.filename.removesuffix(".npy"): member for member in archive.infolist()}
    missing = [name for name in required if name not in members]
    if missing:
        raise LissomError(
            _("{path} has no array {name!r}; it has {names}").format(
                path=path, name=missing[0], names=", ".join(sorted(members)[:50])
            )
        )
    wanted = {name: members[name] for name in (*required, *optional) if name in members}
    unpacked = sum(member.file_size for member in wanted.values())
    if unpacked > size + MOST_UNPACKED:
        raise LissomError(
            _("{path} would unpack to {unpacked:,} bytes, too many for its arrays").format(
                path=path, unpacked=unpacked
            )
        )
    return wanted


def _read_array(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> npt.NDArray[Any]:
    # Read by hand: NumPy's reader would trust any shape and allocate memory for it.
    with archive.open(member) as stream:
        shape, is_fortran, dtype = HEADERS[np.lib.format.read_magic(stream)](stream)
        if dtype.kind in TEXT:
            name = member.filename.removesuffix(".npy")
            raise LissomError(
                _("the array {name!r} contains text; it must contain numbers").format(name=name)
            )
        if dtype.kind not in NUMERIC or any(side < 0 for side in shape):
            raise ValueError(f"{member.filename} is no numeric array")
        if math.prod(shape) * dtype.itemsize != member.file_size - stream.tell():
            raise ValueError(f"{member.filename} is cut short")
        content = bytearray(stream.read(member.file_size))
    return np.frombuffer(content, dtype).reshape(shape, order="F" if is_fortran else "C")
