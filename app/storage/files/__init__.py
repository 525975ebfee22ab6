"""Files on the disk, whatever their contents: read within limits, written whole, locked.

In: paths, and contents to write.
Out: bytes, arrays and JSON; files that are whole or absent; locks that end with their process.
Imports: nothing of the project but `app.errors`.
"""

from app.storage.files.arrays import (
    NO_ARRAYS as NO_ARRAYS,
    read_arrays as read_arrays,
    write_arrays as write_arrays,
)
from app.storage.files.atomic import (
    atomic_file as atomic_file,
    atomic_files as atomic_files,
    remove_abandoned_files as remove_abandoned_files,
    sync_folder as sync_folder,
    temporary_picture as temporary_picture,
    write_atomically as write_atomically,
)
from app.storage.files.cancellation import Cancellation as Cancellation
from app.storage.files.file_lock import FileLock as FileLock, FileLockedError as FileLockedError
from app.storage.files.locks import is_locked as is_locked, lock as lock
from app.storage.files.outputs import (
    IS_FILE as IS_FILE,
    IS_FOLDER as IS_FOLDER,
    NO_FOLDER as NO_FOLDER,
    SAME_FILE as SAME_FILE,
    check_writable as check_writable,
    make_folder as make_folder,
)
from app.storage.files.reading import (
    DAMAGED_ZIP as DAMAGED_ZIP,
    MOST_UNPACKED as MOST_UNPACKED,
    open_file as open_file,
    open_zip as open_zip,
    read_file as read_file,
    tail_digest as tail_digest,
)
from app.storage.files.strict_json import NOT_FINITE as NOT_FINITE, strict_json as strict_json
