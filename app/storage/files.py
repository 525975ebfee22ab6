"""Reading and writing files so that the person's work is never half there."""

import os
import secrets
import stat
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from app.errors import LissomError

NEW_FILE = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)


def write_atomically(path: Path, write: Callable[[IO[bytes]], object]) -> None:
    """Write a file so that at any moment the old or the new one is whole.

    Parameters
    ----------
    path : Path
        Used exactly as given; an existing file is replaced. Of a link, that is what it points to.
    write : callable
        Writes the contents to the open binary file that it is handed.

    Raises
    ------
    LissomError
        As `check_writable`, or if the disk refuses.
    """
    with atomic_file(path) as file:
        write(file)


@contextmanager
def atomic_file(path: Path) -> Iterator[IO[bytes]]:
    """Open a file that takes the place of `path` when the `with` block ends without an error.

    Raises
    ------
    LissomError
        As `write_atomically`; an `OSError` of the block counts as the disk's refusal.
    """
    check_writable(path)
    target = Path(os.path.realpath(path))
    temporary = target.with_name(f".lissom-{secrets.token_hex(8)}.part")
    try:
        # The file that is replaced hands on its permissions. Those of a new one are the system's
        # affair: to ask for the umask would change it for all threads.
        mode = stat.S_IMODE(target.stat().st_mode) if target.exists() else None
        with os.fdopen(
            os.open(temporary, NEW_FILE, 0o666 if mode is None else 0o600), "wb"
        ) as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        if mode is not None:
            temporary.chmod(mode)
        temporary.replace(target)
    except OSError as error:
        raise LissomError(f"cannot write {path}: {_reason(error)}") from error
    finally:
        temporary.unlink(missing_ok=True)


def check_writable(path: Path) -> None:
    """Refuse an output path that cannot work, before any long computation.

    Raises
    ------
    LissomError
        If it is a folder, or a link that leads in a circle, or its folder is missing.
    """
    if path.is_dir():
        raise LissomError(f"cannot write {path}: it is a folder; name a file")
    target = Path(os.path.realpath(path))
    if target.is_symlink():
        raise LissomError(f"cannot write {path}: it is a link that leads in a circle")
    if not target.parent.is_dir():
        folder = target.parent if path.is_symlink() else path.parent
        raise LissomError(f"cannot write {path}: the folder {folder} does not exist")


def write_arrays(path: Path, arrays: Mapping[str, npt.ArrayLike]) -> None:
    """Write named arrays as an NPZ file, atomically and under exactly this name."""
    contents: dict[str, Any] = {name: np.asarray(values) for name, values in arrays.items()}
    write_atomically(path, lambda file: np.savez(file, **contents))


def read_arrays(
    path: Path, *, required: tuple[str, ...], optional: tuple[str, ...] = ()
) -> dict[str, npt.NDArray[Any]]:
    """Read named arrays from an NPZ file.

    Returns
    -------
    dict
        The required arrays and those of the optional ones that the file holds.

    Raises
    ------
    LissomError
        If the file is missing, is not an NPZ file, is damaged, or lacks a required array.
    """
    try:
        # Opened here: NumPy leaves the file open where it turns out to be no archive.
        with path.open("rb") as file:
            archive = np.load(file, allow_pickle=False)
            if not isinstance(archive, np.lib.npyio.NpzFile):
                raise LissomError(f"{path} is not an NPZ file")
            missing = [name for name in required if name not in archive]
            if missing:
                raise LissomError(
                    f"{path} lacks the array {missing[0]!r}; it holds {archive.files}"
                )
            return {name: archive[name] for name in (*required, *optional) if name in archive}
    except OSError as error:
        raise LissomError(f"cannot read {path}: {_reason(error)}") from error
    except (ValueError, EOFError, KeyError, zipfile.BadZipFile) as error:
        raise LissomError(f"{path} is not an NPZ file of numeric arrays, or is damaged") from error


def _reason(error: OSError) -> str:
    return error.strerror or str(error)
