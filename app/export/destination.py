"""Where an export goes: names that suit its format, and what is there already."""

import re
from pathlib import Path
from typing import Final

from app.errors import LissomError
from app.export_formats import EXPORT_FORMATS
from app.storage import check_writable

_FRAME_NAME: Final = re.compile(r"frame_\d{4,}\.png")


def frame_names(first: int, count: int) -> list[str]:
    """Return the file names of pictures numbered from `first` on; all have equally many digits."""
    digits = max(4, len(str(first + count - 1)))
    return [f"frame_{number:0{digits}d}.png" for number in range(first, first + count)]


def check_destination(out: Path, name: str) -> None:
    """Refuse a path that does not suit a format, before anything long begins.

    Raises
    ------
    LissomError
        If it is a folder instead of a file or the other way round, is named like another format,
        or its folder is missing.
    """
    suffixes = EXPORT_FORMATS[name].suffixes
    if suffixes:
        check_writable(out)
        if out.suffix.lower() in _all_suffixes().difference(suffixes):
            raise LissomError(
                f"{out} is not named like {name}; let the name end in {' or '.join(suffixes)}"
            )
    elif not out.is_dir():
        if out.exists():
            raise LissomError(f"cannot write frames to {out}: it is a file; name a folder")
        if out.suffix.lower() in _all_suffixes():
            raise LissomError(
                f"PNG frames go to a folder, but {out} is named like a file; name a folder, or "
                "choose the format of the name"
            )
        if not out.parent.is_dir():
            raise LissomError(f"cannot write {out}: the folder {out.parent} does not exist")


def suited(out: Path, name: str) -> Path:
    """Return a path with the ending of a format, in place of that of another one.

    Any other dot belongs to the name: a folder `shot.010` stays as it is.
    """
    suffixes = EXPORT_FORMATS[name].suffixes
    if out.suffix.lower() in suffixes or (not suffixes and out.is_dir()):
        return out
    is_of_another = out.suffix.lower() in _all_suffixes()
    stem = out.stem if is_of_another else out.name
    if suffixes:
        return out.with_name(f"{stem}{suffixes[0]}")
    return out.with_name(f"{stem} frames") if is_of_another else out


def folder_within(chosen: Path, name: str) -> Path:
    """Return the folder for frames where a person chose an existing one and a name was proposed.

    It is the chosen one if that is empty, holds frames alone or has the name; else it is a folder
    of that name in it, so that frames never lie among other files.
    """
    try:
        others = [
            path
            for path in chosen.iterdir()
            if not path.name.startswith(".") and not _FRAME_NAME.fullmatch(path.name)
        ]
    except OSError:  # whoever writes there will tell what is wrong
        others = []
    return chosen / name if others and chosen.name != name else chosen


def replaced(out: Path, name: str, frames: list[str]) -> list[str]:
    """Return the names of the files that an export would take the place of."""
    if EXPORT_FORMATS[name].suffixes:
        return [out.name] if out.exists() else []
    return [frame for frame in frames if (out / frame).exists()]


def left_frames(out: Path, frames: list[str]) -> list[str]:
    """Return the names of the frames in a folder that an export will not write again, in order."""
    if not out.is_dir():
        return []
    names = {path.name for path in out.iterdir() if _FRAME_NAME.fullmatch(path.name)}
    return sorted(names.difference(frames))


def _all_suffixes() -> set[str]:
    return {suffix for format_ in EXPORT_FORMATS.values() for suffix in format_.suffixes}
