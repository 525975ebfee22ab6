"""Opening footage: what a file or numbered pictures hold, and their readers."""

import shutil
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from math import gcd
from pathlib import Path
from typing import TYPE_CHECKING, Final

from PIL import Image

from app.document import Footage
from app.errors import LissomError, display_name, install_hint, join_names
from app.storage.files.reading import open_file, read_file
from app.storage.footage.animated import AnimatedReader
from app.storage.footage.footage_reader import FootageReader
from app.storage.footage.numbered import NumberedReader, find_numbered_pictures
from app.storage.pictures.parallel import require_memory
from app.storage.pictures.picture import (
    DAMAGED_PICTURE,
    DECODER_ERRORS,
    FORMATS,
    Picture,
    decode_picture,
    stored_size,
)
from app.texts import N_, _

if TYPE_CHECKING:
    from app.storage.footage.video import VideoReader

VIDEOS: Final = (".mp4", ".mov", ".webm", ".mkv", ".avi", ".m4v", ".mpg", ".mpeg", ".ogv", ".wmv")
NO_VIDEO_LIBRARY = N_(
    "to open videos, install PyAV ({remedy}); numbered pictures and GIFs open without it"
)
MISSING_FILES = N_("The footage {name} is missing: {files} cannot be found in {folder}.")
ONE_PICTURE = N_(
    "{name} is a single picture. Choose a video, an animated picture, or one of several numbered "
    "pictures, such as walk_01.png"
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OpenedFootage:
    """Footage, its first picture, and notices."""

    footage: Footage
    first: Picture
    notices: tuple[str, ...] = ()


def is_video(path: Path) -> bool:
    """Return whether a file's name ends as that of a video."""
    return path.suffix.lower() in VIDEOS


def is_footage(paths: Sequence[Path]) -> bool:
    """Return whether paths are a video, an animated picture, or some of the same numbered pictures.

    A folder stands for the numbered pictures in it.
    """
    if len(paths) == 1 and paths[0].is_dir():
        return any(len(find_numbered_pictures(each).paths) > 1 for each in paths[0].iterdir())
    if all(map(is_video, paths)):
        return len(paths) == 1
    if len(paths) > 1:
        return {*paths} <= {*find_numbered_pictures(paths[0]).paths}
    try:
        return AnimatedReader(paths[0]).picture_count > 1
    except LissomError:
        return False


def inspect_footage(path: Path, fps: float) -> OpenedFootage:
    """Return the footage of a video, an animated picture, or the numbered pictures around a file.

    Pictures without times are shown at `fps` frames a second. In a folder, the first picture by
    name counts.

    Raises `LissomError` if there is no footage, or it cannot be read.
    """
    if path.is_dir():
        path = _first_picture(path)
    if is_video(path):
        return _inspect_video(path)
    stored_size(read_file(path), path.name)  # refuses files that are no pictures
    animated = AnimatedReader(path)
    if animated.picture_count > 1:
        return _inspect_animated(path, animated, fps)
    return _inspect_numbered(path, fps)


def open_footage(footage: Footage) -> FootageReader:
    """Return a reader of the pictures of footage.

    Raises `LissomError` if files are missing, or are no longer those of the footage.
    """
    paths = [Path(footage.folder, name) for name in footage.files]
    missing = [path.name for path in paths if not path.is_file()]
    if missing:
        raise LissomError(
            _(MISSING_FILES).format(
                name=display_name(footage.name),
                files=join_names(missing),
                folder=display_name(footage.folder),
            )
        )
    if footage.is_numbered:
        return NumberedReader(paths, footage.size)
    (path,) = paths
    reader = _video_reader(path) if is_video(path) else AnimatedReader(path)
    if (reader.size, reader.picture_count) != (footage.size, footage.picture_count):
        reader.close()
        raise LissomError(
            _("{name} has changed: it has another size or length. Replace the footage").format(
                name=display_name(path.name)
            )
        )
    return reader


def copy_footage(footage: Footage, folder: Path) -> Footage:
    """Copy the files of footage into a folder, and return the footage of the copies.

    A folder of its own is made for footage whose names are taken there by other files.
    """
    source, target = Path(footage.folder), folder / display_name(Path(footage.name).stem)
    if source.parent == folder:
        return footage
    number = 1
    while target.exists() and not _has_same_files(footage, target):
        number += 1
        target = folder / f"{display_name(Path(footage.name).stem)} {number}"
    try:
        target.mkdir(parents=True, exist_ok=True)
        for name in footage.files:
            if not _is_same_file(source / name, target / name):
                shutil.copy2(source / name, target / name)
    except OSError as error:
        raise LissomError(
            _("cannot copy {name}: {reason}").format(
                name=display_name(footage.name), reason=error.strerror or error
            )
        ) from error
    return replace(footage, folder=str(target.absolute()))


def _has_same_files(footage: Footage, folder: Path) -> bool:
    """Return whether a folder has no other files under the names of footage."""
    source = Path(footage.folder)
    return all(
        _is_same_file(source / name, folder / name)
        for name in footage.files
        if (folder / name).exists()
    )


def _is_same_file(one: Path, other: Path) -> bool:
    """Return whether two files have the same size and time, as a copy has."""
    if not (one.is_file() and other.is_file()):
        return False
    here, there = one.stat(), other.stat()
    return (here.st_size, int(here.st_mtime)) == (there.st_size, int(there.st_mtime))


def _video_reader(path: Path) -> "VideoReader":
    remedy = install_hint("video")
    if remedy:
        raise LissomError(_(NO_VIDEO_LIBRARY).format(remedy=remedy))
    from app.storage.footage.video import VideoReader  # noqa: PLC0415 - only videos need it

    return VideoReader(path)


def _first_picture(folder: Path) -> Path:
    for path in sorted(folder.iterdir()):
        if path.is_file() and len(find_numbered_pictures(path).paths) > 1:
            return path
    raise LissomError(
        _("{folder} has no numbered pictures").format(folder=display_name(folder.name))
    )


def _inspect_video(path: Path) -> OpenedFootage:
    with _video_reader(path) as reader:
        require_memory([reader.size])
        footage = Footage(
            name=display_name(path.name),
            folder=str(path.parent.absolute()),
            files=(path.name,),
            size=reader.size,
            fps=reader.fps,
            picture_count=reader.picture_count,
            holds=reader.holds,
        )
        return OpenedFootage(footage=footage, first=Picture(rgba=reader.read(0)))


def _inspect_animated(path: Path, reader: AnimatedReader, fps: float) -> OpenedFootage:
    delays = reader.delays()
    holds: tuple[int, ...] = ()
    if delays is not None:
        tick = reduce(gcd, delays)
        fps, holds = 1000 / tick, _unless_ones([delay // tick for delay in delays])
    footage = Footage(
        name=display_name(path.name),
        folder=str(path.parent.absolute()),
        files=(path.name,),
        size=reader.size,
        fps=fps,
        picture_count=reader.picture_count,
        holds=holds,
    )
    return OpenedFootage(footage=footage, first=Picture(rgba=reader.read(0)))


def _inspect_numbered(path: Path, fps: float) -> OpenedFootage:
    numbered = find_numbered_pictures(path)
    if len(numbered.paths) == 1:
        raise LissomError(_(ONE_PICTURE).format(name=display_name(path.name)))
    first = decode_picture(read_file(numbered.paths[0]), numbered.paths[0].name)
    sizes = {each.name: _header_size(each) for each in numbered.paths}
    others = [name for name, size in sizes.items() if size != sizes[numbered.paths[0].name]]
    if others:
        raise LissomError(
            _("pictures of footage must have one size; {files} differ from {name}").format(
                files=join_names(others), name=display_name(numbered.paths[0].name)
            )
        )
    notices = []
    if numbered.gaps:
        gaps = [str(one) if one == other else f"{one}–{other}" for one, other in numbered.gaps]
        notices.append(
            _("pictures {numbers} are missing; the picture before each gap holds").format(
                numbers=join_names(gaps)
            )
        )
    footage = Footage(
        name=display_name(numbered.paths[0].name),
        folder=str(numbered.paths[0].parent.absolute()),
        files=tuple(each.name for each in numbered.paths),
        size=first.size,
        fps=fps,
        picture_count=len(numbered.paths),
        holds=_unless_ones(numbered.holds),
    )
    return OpenedFootage(footage=footage, first=first, notices=tuple(notices))


def _header_size(path: Path) -> tuple[int, int]:
    """Return the width and height in the header of a picture file, without reading all of it."""
    try:
        with open_file(path) as (file, _size), Image.open(file, formats=tuple(FORMATS)) as image:
            return image.size
    except DECODER_ERRORS as error:
        raise LissomError(_(DAMAGED_PICTURE).format(name=display_name(path.name))) from error


def _unless_ones(holds: Sequence[int]) -> tuple[int, ...]:
    return tuple(holds) if max(holds) > 1 else ()
