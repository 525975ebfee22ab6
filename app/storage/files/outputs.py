"""Checks of output paths: never an input file, and never anything but a plain file."""

import os
import stat
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from app.errors import LissomError
from app.texts import N_, _

# The identity of a file, whatever its names and links. For a file that does not exist yet: its
# folder and its name.
Identity = tuple[int, int, str]
STREAMS = (0, 1, 2)  # descriptors
NO_FOLDER = N_("the folder {folder} does not exist")
SAME_FILE = N_("cannot write {path}: it is the same file as {other}; name another one")
NO_PLACE = N_("cannot make the folder {folder}: {reason}")
IS_FILE = N_("{file} already exists and is not a folder; choose another name")
IS_FOLDER = N_("it is a folder; name a file")


def check_writable(*outs: Path, sources: Iterable[Path] = ()) -> None:
    """Refuse impossible or destructive output paths before any long computation.

    Parameters
    ----------
    *outs : Path
        All outputs of one command.
    sources : iterable of Path
        The inputs of the command; missing ones are ignored.

    Raises
    ------
    LissomError
        If an output is a folder, no plain file, a circular link or read-only, or if its folder is
        missing. Also if it is the same file as a source or as another output.
    """
    taken: dict[Identity, str] = {}
    for source in sources:
        with suppress(OSError, ValueError):
            taken[_identity(source)] = _("{path}, the file that it is made from").format(
                path=source
            )
    for out in outs:
        try:
            _check_place(out)
            own = _identity(out)
        except (OSError, ValueError) as error:  # ValueError: no file can have this name
            reason = getattr(error, "strerror", None) or error
            raise LissomError(
                _("cannot write {path}: {reason}").format(path=out, reason=reason)
            ) from error
        if own in taken:
            raise LissomError(_(SAME_FILE).format(path=out, other=taken[own]))
        taken[own] = _("{path}, another file that this command writes").format(path=out)


def make_folder(folder: Path) -> None:
    """Make a folder for outputs and its missing parents, or raise `LissomError`."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError) as error:
        around = (folder, *folder.parents)
        file = next(each for each in around if os.path.lexists(each))
        reason = _(IS_FILE).format(file=file)
        raise LissomError(_(NO_PLACE).format(folder=folder, reason=reason)) from error
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise LissomError(_(NO_PLACE).format(folder=folder, reason=reason)) from error


def _check_place(path: Path) -> None:
    target = Path(os.path.realpath(path))
    if target.is_symlink():
        raise LissomError(
            _("cannot write {path}: it is a link that leads in a circle").format(path=path)
        )
    try:
        status = target.stat()
    except (FileNotFoundError, NotADirectoryError):
        if not target.parent.is_dir():
            folder = target.parent if path.is_symlink() else path.parent
            raise LissomError(
                _("cannot write {path}: {reason}").format(
                    path=path, reason=_(NO_FOLDER).format(folder=folder)
                )
            ) from None
        return
    if stat.S_ISDIR(status.st_mode):
        raise LissomError(_("cannot write {path}: {reason}").format(path=path, reason=_(IS_FOLDER)))
    if not stat.S_ISREG(status.st_mode) or _is_stream(status):
        raise LissomError(
            _(
                "cannot write {path}: it is a device, a pipe, a socket or standard output, "
                "which Lissom does not replace; name an ordinary file"
            ).format(path=path)
        )
    if not os.access(target, os.W_OK):
        # In a writable folder the system would allow replacing a read-only file.
        raise LissomError(
            _(
                "cannot write {path}: the file is read-only; choose another name, or allow "
                "writing to the file"
            ).format(path=path)
        )


def _is_stream(status: os.stat_result) -> bool:
    """Return whether a file is a standard stream of this process, such as /dev/stdout."""
    for descriptor in STREAMS:
        with suppress(OSError):  # the stream may be closed
            if os.path.samestat(status, os.fstat(descriptor)):
                return True
    return False


def _identity(path: Path) -> Identity:
    target = Path(os.path.realpath(path))
    try:
        status, name = target.stat(), ""
    except (FileNotFoundError, NotADirectoryError):
        status, name = target.parent.stat(), os.path.normcase(target.name)
    return status.st_dev, status.st_ino, name
