"""Where an export goes: names that suit its format, and what is there already."""

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

FRAMES: Final = " frames"  # what the name of a folder for them ends in
# Stands for the project's name.
PROJECT: Final = "{name}"
# A name's last dot is no ending where a number follows, as in v1.2.
_ENDING: Final = re.compile(r"\.[a-z]\w*")
NAMED_LIKE_FILE = (
    "{label} go to a folder, but {out} is named like a file; name a folder, or choose the format "
    "of the name"
)
FRAMES_TO_FILE = "cannot write frames to {out}: it is a file; name a folder"
TOO_LITTLE_ROOM = (
    "there are only {left:,.1f} MB left where {folder} is, and this export takes {needed:,.1f} MB "
    "or more; make room or choose another folder"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class FrameNames:
    """How the files of frames are called.

    Parameters
    ----------
    pattern : str
        As in `ExportSettings.names`.
    project : str
        The name of the project.
    """

    pattern: str
    project: str

    def of(self, first: int, count: int) -> list[str]:
        """Return the names of pictures numbered from `first` on; all have equally many digits."""
        start, digits, end = self._parts()
        width = max(digits, len(str(first + count - 1)))
        return [f"{start}{number:0{width}d}{end}" for number in range(first, first + count)]

    def fits(self, name: str) -> bool:
        """Tell whether a file is named as a frame is."""
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
    """Refuse a path that does not suit a format, before anything long begins.

    Parameters
    ----------
    frames : sequence of str
        The names of the pictures, where each is a file of its own.
    sources : iterable of Path
        The files that the export is made from.

    Raises
    ------
    LissomError
        If it is a folder instead of a file or the other way round, is named like another format or
        by an ending alone, or its folder is missing or may not be written to; or as
        `check_writable`, of every file.
    """
    suffixes, label = EXPORT_FORMATS[name].suffixes, EXPORT_FORMATS[name].label
    if out.name.lower() in _all_suffixes():
        raise LissomError(
            f"{out} is only the ending of a name; put a name before it, as in animation{out.name}"
        )
    if suffixes:
        check_writable(*_files(out, name, frames), sources=sources)
        ending = out.suffix.lower()
        if ending not in suffixes and (ending in _all_suffixes() or _ENDING.fullmatch(ending)):
            raise LissomError(
                f"{out} is not named like {name}; let the name end in {' or '.join(suffixes)}"
            )
    elif out.is_dir():
        there = [file for file in _files(out, name, frames) if os.path.lexists(file)]
        check_writable(*there, sources=sources)
    else:
        if out.exists():
            raise LissomError(FRAMES_TO_FILE.format(out=out))
        if out.suffix.lower() in _all_suffixes():
            raise LissomError(NAMED_LIKE_FILE.format(label=label, out=out))
        if not out.parent.is_dir():
            raise LissomError(f"cannot write {out}: {NO_FOLDER.format(folder=out.parent)}")
    folder = out if out.is_dir() else out.parent
    if not os.access(folder, os.W_OK):
        raise LissomError(
            f"cannot write {out}: the folder {folder} may not be written to; choose another one"
        )


def check_room(out: Path, needed: int) -> None:
    """Refuse an export for which there is not room enough.

    Parameters
    ----------
    out : Path
        Its folder exists.
    needed : int
        Bytes that it takes at least.

    Raises
    ------
    LissomError
        If the disk has less.
    """
    folder = out if out.is_dir() else out.parent
    free = shutil.disk_usage(folder).free
    if free < needed:
        raise LissomError(
            TOO_LITTLE_ROOM.format(left=free / 1e6, folder=folder, needed=needed / 1e6)
        )


def data_file(out: Path, name: str) -> Path | None:
    """Return where the data of a format go, beside its file; None where it has none."""
    format_ = EXPORT_FORMATS[name]
    stem = out.stem if out.suffix.lower() in format_.suffixes else out.name
    return out.parent / f"{stem}{format_.data_suffix}" if format_.data_suffix else None


def with_suffix_for(out: Path, name: str) -> Path:
    """Return a path with the ending of a format, in place of that of another one.

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
    """Return the folder for frames where a person chose an existing one and a name was proposed.

    It is the chosen one if that is empty, holds frames alone or has the name; else it is a folder
    of that name in it, so that frames never lie among other files.
    """
    try:
        others = [
            path
            for path in chosen.iterdir()
            if not path.name.startswith(".") and not is_frame(path.name)
        ]
    except OSError:  # whoever writes there will tell what is wrong
        others = []
    return chosen / name if others and chosen.name != name else chosen


def find_overwritten_files(out: Path, name: str, frames: Sequence[str]) -> list[str]:
    """Return the names of the files that an export would take the place of."""
    return [file.name for file in _files(out, name, frames) if file.exists()]


def find_stale_frames(out: Path, names: FrameNames, frames: list[str]) -> list[str]:
    """Return the names of the frames in a folder that an export will not write again, in order."""
    if not out.is_dir():
        return []
    there = {path.name for path in out.iterdir() if names.fits(path.name)}
    return sorted(there.difference(frames))


def _files(out: Path, name: str, frames: Sequence[str]) -> list[Path]:
    """Return all files that an export writes."""
    if not EXPORT_FORMATS[name].suffixes:
        return [out / frame for frame in frames]
    return [file for file in (out, data_file(out, name)) if file is not None]


def _all_suffixes() -> set[str]:
    return {suffix for format_ in EXPORT_FORMATS.values() for suffix in format_.suffixes}
