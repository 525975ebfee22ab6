"""The container of a project file: a zip whose members are read by name, and never extracted."""

import io
import re
import zipfile
from collections.abc import Mapping
from types import MappingProxyType
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from app.errors import LissomError
from app.storage.files.reading import MOST_UNPACKED
from app.texts import N_, _
from engine.arrays import Bytes, Complexes, Floats, Integers, readonly

MIMETYPE = b"application/x-lissom"
NO_PROJECT = N_("it is not a Lissom project")
MOST_MEMBERS = 65_535
MEBIBYTE = 1024 * 1024
# Members to deflate. Pictures are packed already, and the mimetype stays legible.
PACKED = (".json", ".npy")
# A constant date: the same document always gives the same bytes.
DATE = (1980, 1, 1, 0, 0, 0)
NPY_MAGIC = b"\x93NUMPY\x01\x00"
LARGEST_NPY_HEADER = 1024
NOT_ARRAY = N_("its {name} is not an array of type {dtype} and shape (n{shape})")
MEMBER_CUT_SHORT = N_("its {name} is cut short")
MEMBER_TOO_LARGE = N_("its {name} is too large: {size:,} bytes; at most {most:,} are allowed")
NOTHING_WRITTEN: Mapping[str, bytes] = MappingProxyType({})


def write_archive(file: IO[bytes], members: Mapping[str, bytes]) -> None:
    """Write the members by name, after the mimetype.

    Members that would unpack beyond the reading limit of a small file are not packed.
    """
    packs = sum(map(len, members.values())) <= MOST_UNPACKED
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in {"mimetype": MIMETYPE, **members}.items():
            member = zipfile.ZipInfo(name, DATE)
            member.external_attr = 0o644 << 16
            packed = packs and name.endswith(PACKED)
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
        As opened by `open_zip`.
    size : int
        Bytes of the file on the disk. At most `size` plus `MOST_UNPACKED` bytes are ever unpacked.
    written : mapping of str to bytes
        Contents that were just written to the file; reading returns them without unpacking.

    Raises
    ------
    LissomError
        If it is another kind of zip file, has another layout than `write_archive` gives, or would
        unpack to too much. These checks read only the table of contents.
    """

    def __init__(
        self, file: zipfile.ZipFile, size: int, written: Mapping[str, bytes] = NOTHING_WRITTEN
    ) -> None:
        self._file = file
        self._written = written
        self._read: set[str] = set()
        members = file.infolist()
        if len(members) > MOST_MEMBERS:
            raise LissomError(
                _("it has {count:,} members; a project has at most {most:,}").format(
                    count=len(members), most=MOST_MEMBERS
                )
            )
        if not members or members[0].filename != "mimetype":
            raise LissomError(_(NO_PROJECT))
        # Layers were figures in schemas 1 and 2.
        self._members = {
            re.sub("^figures/", "layers/", member.filename): member for member in members
        }
        if len(self._members) < len(members):
            raise LissomError(_("it has two members of the same name"))
        if sum(member.compress_size for member in members) > size:
            raise LissomError(_("it is damaged: its members overlap"))
        unpacked = sum(member.file_size for member in members)
        if unpacked > size + MOST_UNPACKED:
            raise LissomError(
                _("it would unpack to {unpacked:,} bytes, too many for a project").format(
                    unpacked=unpacked
                )
            )
        if self.read("mimetype", largest=len(MIMETYPE)) != MIMETYPE:
            raise LissomError(_(NO_PROJECT))

    @property
    def is_written(self) -> bool:
        """Whether the file was just written, so that its maps are already certified."""
        return bool(self._written)

    @property
    def unread(self) -> list[str]:
        """Names of members that were not read, without folders."""
        return [n for n in self._members if n not in self._read and not n.endswith("/")]

    def has(self, name: str) -> bool:
        return name in self._members

    def read(self, name: str, *, largest: int | None = None) -> bytes:
        """Return the contents of a member, of at most `largest` bytes.

        Raises `LissomError` if the member is missing or larger; nothing is unpacked then.
        """
        if name not in self._members:
            raise LissomError(_("it lacks {name}").format(name=name))
        self._read.add(name)
        member = self._members[name]
        if largest is not None and member.file_size > largest:
            raise LissomError(
                _(MEMBER_TOO_LARGE).format(name=name, size=member.file_size, most=largest)
            )
        if name in self._written and len(self._written[name]) == member.file_size:
            return self._written[name]
        # Reading with the given size never unpacks more, however far the data would grow. A wrong
        # checksum is an error.
        with self._file.open(member) as packed:
            content = packed.read(member.file_size)
        if len(content) < member.file_size:
            raise LissomError(_(MEMBER_CUT_SHORT).format(name=name))
        return content

    def points(self, name: str, *, most: int) -> Complexes:
        """Return an array of at most `most` points, complex128 (n,)."""
        array = self._array(name, np.dtype("<c16"), columns=1, most=most)
        return readonly(array.astype(np.complex128, copy=False))

    def numbers(self, name: str, *, most: int) -> Floats:
        """Return an array of at most `most` numbers, float64 (n,)."""
        array = self._array(name, np.dtype("<f8"), columns=1, most=most)
        return readonly(array.astype(np.float64, copy=False))

    def triangles(self, name: str, *, most: int) -> Integers:
        """Return an array of at most `most` triangles, int32 (m, 3)."""
        array = self._array(name, np.dtype("<i4"), columns=3, most=most)
        return readonly(array.astype(np.int32, copy=False).reshape(-1, 3))

    def bytes(self, name: str, *, most: int) -> Bytes:
        """Return an array uint8 (n,) of at most `most` bytes."""
        array = self._array(name, np.dtype("|u1"), columns=1, most=most)
        return readonly(array.astype(np.uint8, copy=False))

    def _array(
        self, name: str, dtype: np.dtype[Any], *, columns: int, most: int
    ) -> npt.NDArray[Any]:
        # Read by hand: NumPy's reader would trust any shape and allocate memory for it.
        row = columns * dtype.itemsize
        content = self.read(name, largest=LARGEST_NPY_HEADER + most * row)
        start = 10 + int.from_bytes(content[8:10], "little")
        shape = "," if columns == 1 else f", {columns}"
        kind = re.escape(dtype.str)
        pattern = rf"{{'descr': '{kind}', 'fortran_order': False, 'shape': \((\d+){shape}\), }} *\n"
        match = re.fullmatch(pattern.encode(), content[10:start])
        if not content.startswith(NPY_MAGIC) or match is None:
            raise LissomError(_(NOT_ARRAY).format(name=name, dtype=dtype.name, shape=shape))
        if len(content) - start != int(match[1]) * row:
            raise LissomError(_(MEMBER_CUT_SHORT).format(name=name))
        return np.frombuffer(content, dtype, offset=start)
