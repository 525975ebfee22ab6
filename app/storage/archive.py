"""The container of a project file: a zip whose members are read by name, and never extracted."""

import io
import re
import zipfile
from collections.abc import Mapping
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from app.errors import LissomError
from engine.arrays import Complexes, Integers, readonly

MIMETYPE = b"application/x-lissom"
MOST_MEMBERS = 65_535
MEBIBYTE = 1024 * 1024
LARGEST_ARRAY = 256 * MEBIBYTE
# Members that deflating makes smaller; pictures are packed already, and the mimetype stays legible.
PACKED = (".json", ".npy")
# The same document gives the same bytes, whenever it is saved.
DATE = (1980, 1, 1, 0, 0, 0)
NPY_MAGIC = b"\x93NUMPY\x01\x00"


def write_archive(file: IO[bytes], members: Mapping[str, bytes]) -> None:
    """Write the members, by their names, after the one that tells what the file is."""
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in {"mimetype": MIMETYPE, **members}.items():
            member = zipfile.ZipInfo(name, DATE)
            member.external_attr = 0o644 << 16
            packed = name.endswith(PACKED)
            member.compress_type = zipfile.ZIP_DEFLATED if packed else zipfile.ZIP_STORED
            archive.writestr(member, content, compresslevel=1)


def array_member(array: npt.NDArray[Any]) -> bytes:
    """Return an array as the contents of an .npy file, little-endian on every machine."""
    file = io.BytesIO()
    np.save(file, array.astype(array.dtype.newbyteorder("<"), copy=False), allow_pickle=False)
    return file.getvalue()


class Archive:
    """The members of a project file.

    Parameters
    ----------
    file : ZipFile
        Open for reading.

    Raises
    ------
    LissomError
        If it is another kind of zip file, or not laid out as `write_archive` does.
    """

    def __init__(self, file: zipfile.ZipFile) -> None:
        members = file.infolist()
        if len(members) > MOST_MEMBERS:
            raise LissomError(f"it has {len(members):,} members, more than any project")
        if not members or members[0].filename != "mimetype":
            raise LissomError("it is not a Lissom project")
        self._file = file
        self._members = {member.filename: member for member in members}
        if len(self._members) < len(members):
            raise LissomError("it has two members of one name")
        if self.read("mimetype", largest=len(MIMETYPE)) != MIMETYPE:
            raise LissomError("it is not a Lissom project")

    def __contains__(self, name: str) -> bool:
        return name in self._members

    def read(self, name: str, *, largest: int) -> bytes:
        """Return the contents of a member, of at most `largest` bytes.

        Raises
        ------
        LissomError
            If it is missing or larger, before anything is unpacked.
        """
        if name not in self:
            raise LissomError(f"it lacks {name}")
        member = self._members[name]
        if member.file_size > largest:
            raise LissomError(f"its {name} is too large: {member.file_size:,} bytes")
        # With the size given, no more than that is ever unpacked, whatever the data would grow to;
        # a checksum that differs is an error.
        with self._file.open(member) as packed:
            content = packed.read(member.file_size)
        if len(content) < member.file_size:
            raise LissomError(f"its {name} is cut short")
        return content

    def points(self, name: str) -> Complexes:
        """Return an array of points, complex128 (n,)."""
        return self._array(name, np.dtype("<c16"), "complex128 (n,)", r"(\d+),").astype(
            np.complex128, copy=False
        )

    def triangles(self, name: str) -> Integers:
        """Return an array of triangles, int32 (m, 3)."""
        return self._array(name, np.dtype("<i4"), "int32 (m, 3)", r"(\d+), 3").astype(
            np.int32, copy=False
        )

    def _array(self, name: str, dtype: np.dtype[Any], what: str, shape: str) -> npt.NDArray[Any]:
        # Read by hand: NumPy's reader would believe any shape and allocate it.
        content = self.read(name, largest=LARGEST_ARRAY)
        length = int.from_bytes(content[8:10], "little")
        header = content[10 : 10 + length]
        pattern = rf"{{'descr': '{dtype.str}', 'fortran_order': False, 'shape': \({shape}\), }} *\n"
        match = re.fullmatch(pattern.encode(), header)
        data = content[10 + length :]
        if not content.startswith(NPY_MAGIC) or match is None:
            raise LissomError(f"its {name} is not an array {what}")
        row = dtype.itemsize * (3 if dtype.kind == "i" else 1)
        if len(data) != int(match[1]) * row:
            raise LissomError(f"its {name} is cut short")
        array = np.frombuffer(data, dtype)
        return readonly(array.reshape(-1, 3) if dtype.kind == "i" else array)
