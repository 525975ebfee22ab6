"""Files on the disk, whatever is in them: read within limits, written whole, held against others.

In: paths, and what is written to them.
Out: bytes and arrays; files that are whole or absent; locks that end with their process.
Imports: nothing of the project but `app.errors`.
"""

from app.storage.files.arrays import read_arrays, write_arrays
from app.storage.files.atomic import (
    atomic_file,
    check_writable,
    clear_abandoned,
    passing_picture,
    sync_folder,
    write_atomically,
)
from app.storage.files.cancellation import Cancellation
from app.storage.files.hold import Hold, HoldError
from app.storage.files.locks import is_locked, lock
from app.storage.files.reading import DAMAGED_ZIP, read_file, require_file, tail_digest

__all__ = [
    "DAMAGED_ZIP",
    "Cancellation",
    "Hold",
    "HoldError",
    "atomic_file",
    "check_writable",
    "clear_abandoned",
    "is_locked",
    "lock",
    "passing_picture",
    "read_arrays",
    "read_file",
    "require_file",
    "sync_folder",
    "tail_digest",
    "write_arrays",
    "write_atomically",
]
