"""The destination of an export: names that suit its format, and existing files."""

import os
import re
import shutil
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from app.errors import LissomError
from app.export_formats import EXPORT_FORMATS
from app.storage import NO_FOLDER, check_writable
from app.texts import N_, _

FRAMES: Final = " frames"  # suffix of a frame folder's name
# Placeholder of the project's name.
PROJECT: Final = "{name}"
# A dot before a digit starts no suffix, as in v1.2.
_ENDING: Final = re.compile(r"\.[a-z]\w*")
NAMED_LIKE_FILE = N_(
    "{label} need a folder, but {out} is the name of a file. Name a folder, or choose the "
    "format of that file"
)
FRAMES_TO_FILE = N_("cannot write frames to {out}: it is a file; name a folder")
TOO_LITTLE_ROOM = N_(
    "the export needs {needed:,.1f} MB or more, but {folder} has only {left:,.1f} MB left. Free "
    "some space, or choose another folder"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class FrameNames:
    """File names of frames; `pattern` is as in `ExportSettings.names`."""

    pattern: str
    project: str

    def of(self, first: int, count: int) -> list[str]:
        """Return the names of `count` frames from number `first`; all have equally many digits."""
        start, digits, end = self._parts()
        width = max(digits, len(str(first + count - 1)))
        return [f"{start}{number:0{width}d}{end}" for number in range(first, first + count)]

    def fits(self, name: str) -> bool:
        start, digits, end = self._parts()
        pattern = rf"{re.escape(start)}\d{{{digits},}}{re.escape(end)}"
        return re.fullmatch(pattern, name) is not None

    def _parts(self) -> tuple[str, int, str]:
        start, digits, end = re.split("(#+)", self.pattern)
        start, end = (part.replace(PROJECT, self.project) for part in (start, end))
        return start, len(digits), f"{end}.png"


def check_destination(
    out: Path, name: str, frames: Sequence[str] = (), sources: Iterable[Path] = ()
) -> None:
    """Refuse a path that does not suit the format, before any long computation.

    Parameters
    ----------
    frames : sequence of str
        The names of the pictures, if each is a file of its own.
    sources : iterable of Path
        The input files of the export.

    Raises
    ------
    LissomError
        If a folder is given for a file or a file for a folder, or the suffix belongs to another
        format or is the whole name. Also if the folder is missing or read-only, and as
        `check_writable` for every file.
    """
    suffixes, label = EXPORT_FORMATS[name].suffixes, EXPORT_FORMATS[name].label
    if out.name.lower() in _all_suffixes():
        raise LissomError(
            _(
                "{out} is only the ending of a file name; add a name before it, as in "
                "animation{ending}"
            ).format(out=out, ending=out.name)
        )
    if suffixes:
        check_writable(*_files(out, name, frames), sources=sources)
        ending = out.suffix.lower()
        if ending not in suffixes and (ending in _all_suffixes() or _ENDING.fullmatch(ending)):
            raise LissomError(
                _("{out} is not a file name for {name}; use the ending {suffixes}").format(
                    out=out, name=name, suffixes=", ".join(suffixes)
                )
            )
    elif out.is_dir():
        there = [file for file in _files(out, name, frames) if os.path.lexists(file)]
        check_writable(*there, sources=sources)
    else:
        if out.exists():
            raise LissomError(_(FRAMES_TO_FILE).format(out=out))
        if out.suffix.lower() in _all_suffixes():
            raise LissomError(_(NAMED_LIKE_FILE).format(label=label, out=out))
        if not out.parent.is_dir():
            raise LissomError(
                _("cannot write {path}: {reason}").format(
                    path=out, reason=_(NO_FOLDER).format(folder=out.parent)
                )
            )
    folder = out if out.is_dir() else out.parent
    if not os.access(folder, os.W_OK):
        raise LissomError(
            _(
                "cannot write {out}: you have no permission to write to {folder}; choose "
                "another folder"
            ).format(out=out, folder=folder)
        )


def check_room(out: Path, needed: int) -> None:
    """Raise `LissomError` if the disk lacks the `needed` bytes; the folder of `out` must exist."""
    folder = out if out.is_dir() else out.parent
    free = shutil.disk_usage(folder).free
    if free < needed:
        raise LissomError(
            _(TOO_LITTLE_ROOM).format(left=free / 1e6, folder=folder, needed=needed / 1e6)
        )


def data_file(out: Path, name: str) -> Path | None:
    """Return the path of the format's data file beside the output; None if it has none."""
    format_ = EXPORT_FORMATS[name]
    stem = out.stem if out.suffix.lower() in format_.suffixes else out.name
    return out.parent / f"{stem}{format_.data_suffix}" if format_.data_suffix else None


def with_suffix_for(out: Path, name: str) -> Path:
    """Return a path with the suffix of this format in place of another format's suffix.

    A folder of frames ends in a word. Any other dot belongs to the name: a folder `shot.010` stays
    as it is.
    """
    suffixes = EXPORT_FORMATS[name].suffixes
    if out.suffix.lower() in suffixes or (not suffixes and out.is_dir()):
        return out
    is_of_another = out.suffix.lower() in _all_suffixes()
    if not (suffixes or is_of_another):
        return out
    stem = (out.stem if is_of_another else out.name).removesuffix(FRAMES) or out.stem
    return out.with_name(stem + (suffixes[0] if suffixes else FRAMES))


def choose_frame_folder(chosen: Path, name: str, is_frame: Callable[[str], bool]) -> Path:
    """Return the folder for frames from a person's chosen folder and a proposed name.

    Frames never lie among other files. The chosen folder is used if it is empty, holds only frames,
    or has the proposed name. Otherwise a folder of that name is made in it.
    """
    try:
        others = [
            path
            for path in chosen.iterdir()
            if not path.name.startswith(".") and not is_frame(path.name)
        ]
    except OSError:  # the writer reports the problem later
        others = []
    return chosen / name if others and chosen.name != name else chosen


def find_overwritten_files(out: Path, name: str, frames: Sequence[str]) -> list[str]:
    """Return the names of existing files that an export replaces."""
    return [file.name for file in _files(out, name, frames) if file.exists()]


def find_stale_frames(out: Path, names: FrameNames, frames: list[str]) -> list[str]:
    """Return the sorted names of frames in a folder that an export does not rewrite."""
    if not out.is_dir():
        return []
    there = {path.name for path in out.iterdir() if names.fits(path.name)}
    return sorted(there.difference(frames))


def _files(out: Path, name: str, frames: Sequence[str]) -> list[Path]:
    """Return all output files of an export."""
    if not EXPORT_FORMATS[name].suffixes:
        return [out / frame for frame in frames]
    return [file for file in (out, data_file(out, name)) if file is not None]


def _all_suffixes() -> set[str]:
    return {suffix for format_ in EXPORT_FORMATS.values() for suffix in format_.suffixes}
