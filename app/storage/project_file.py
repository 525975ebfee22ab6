"""Saving and opening projects.

A project is a zip file: `mimetype` (first, not packed), `project.json`, `thumbnail.png`, and a
folder for each layer under `layers/`, named by its id. This folder holds the picture, the arrays of
the domain, and the maps of the poses. The maps are stored, so that another solver never changes an
animation. Bytes of sounds are under `sounds/`. Footage stays in files of its own, which are named
relative to the project's folder. Unknown fields and members are kept and written
again.

A project file is untrusted input. Unpacked sizes are limited before anything is unpacked. Pictures
and domains are checked. Certificates are not stored: the maps are certified again. For any damaged
file, reading takes at most half a gigabyte plus some ten times the file's size.
"""

import json
import os
from collections.abc import Mapping
from dataclasses import replace
from math import isfinite
from pathlib import Path
from types import MappingProxyType
from typing import IO, Final
from weakref import WeakSet

from app.document import Document, Layer
from app.errors import EXPECTED_ERRORS, LissomError, shortened
from app.storage.files.atomic import sync_folder, write_atomically
from app.storage.files.reading import DAMAGED_ZIP, open_file, open_zip, tail_digest
from app.storage.json_values import JsonObject, as_object, as_text, as_whole, check_repeated_fields
from app.storage.project.archive import MEBIBYTE, Archive, write_archive
from app.storage.project.document_json import SCHEMA, read_document, write_document
from app.storage.project.footage import footage_found_from, footage_relative_to
from app.storage.project.members import layer_members
from app.storage.project.sounds import sound_members
from app.texts import N_, _, message_of

LARGEST_JSON = 32 * MEBIBYTE
# In project.json. A thousand keys of a hundred handles have this many.
MOST_VALUES = 1_000_000
LARGEST_THUMBNAIL = 2 * MEBIBYTE
PROJECT_JSON, THUMBNAIL = "project.json", "thumbnail.png"
# Nesting of lists and objects. Unknown fields are kept, and must be writable.
DEEPEST = 40
NEWER_LISSOM = N_(
    "a newer Lissom ({version}, schema {schema}) saved it; this version reads schema {own}. "
    "Update Lissom to open it"
)
_readable: Final = WeakSet[Layer]()  # layers unchanged since they were read from a file


def save_project(
    path: Path, document: Document, *, thumbnail: bytes | None = None, is_private: bool = False
) -> str:
    """Write a project file; at any moment the old or the new one is whole.

    Parameters
    ----------
    path : Path
        Used exactly as given.
    thumbnail : bytes, optional
        A small PNG picture of the animation.
    is_private : bool
        Whether only the person may read the file.

    Returns
    -------
    str
        The file's `project_digest`, until another process writes there.
    """
    content = write_document(footage_relative_to(document, path.parent))
    members = {
        PROJECT_JSON: json.dumps(content, indent=1, sort_keys=True, allow_nan=False).encode(),
    }
    for layer in document.layers:
        members |= layer_members(layer)
    members |= sound_members(document)
    if thumbnail is not None:
        members[THUMBNAIL] = thumbnail
    # Members of later versions stay, but never replace this version's members.
    members = {**document.unknown_members, **members}

    def write(file: IO[bytes]) -> str:
        write_archive(file, members)
        _require_readable(path, file, members, document)
        return tail_digest(file)

    digest = write_atomically(path, write, is_private=is_private)
    sync_folder(path.parent)
    return digest


def project_digest(path: Path) -> str | None:
    """Return a digest that identifies the contents of a project file; None if there is no file."""
    try:
        with open_file(path) as (file, _):
            return tail_digest(file)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise LissomError(
            _("cannot read {path}: {reason}").format(path=path, reason=error.strerror or error)
        ) from error


def load_project(path: Path) -> Document:
    """Read a project file.

    Raises `LissomError` if the file is missing, is no project, was written by a newer version, or
    is damaged. The message names the reason.
    """
    try:
        with open_file(path) as (file, size), open_zip(file) as members:
            document = footage_found_from(_read(Archive(members, size)), path.parent)
    except OSError as error:
        raise LissomError(
            _("cannot read {path}: {reason}").format(path=path, reason=error.strerror or error)
        ) from error
    except EXPECTED_ERRORS as error:
        raise LissomError(
            _("cannot open {path}: {error}").format(path=path, error=message_of(error))
        ) from error
    except DAMAGED_ZIP as error:
        raise LissomError(
            _("cannot open {path}: it is not a Lissom project, or it is damaged").format(path=path)
        ) from error
    _readable.update(document.layers)
    return document


def load_thumbnail(path: Path) -> bytes | None:
    """Read only the thumbnail of a project, a PNG file; None without thumbnail or project."""
    return load_member(path, THUMBNAIL, LARGEST_THUMBNAIL)


def load_member(path: Path, name: str, largest: int) -> bytes | None:
    """Read only one member of a project; None if it is missing or the file is no project."""
    try:
        with open_file(path) as (file, size), open_zip(file) as members:
            return Archive(members, size).read(name, largest=largest)
    except (OSError, *EXPECTED_ERRORS, *DAMAGED_ZIP):
        return None


def _require_readable(
    path: Path, file: IO[bytes], members: Mapping[str, bytes], document: Document
) -> None:
    """Refuse a just written file unless it can be opened again.

    Reads values and sizes; arrays and certified maps are taken from memory. Unchanged layers of an
    earlier reading are skipped: nearly all, if a project is saved again.
    """
    known = {layer.id: layer for layer in document.layers if layer in _readable}
    arrays = {name: content for name, content in members.items() if name != PROJECT_JSON}
    size = file.seek(0, os.SEEK_END)
    try:
        with open_zip(file) as written:
            _read(Archive(written, size, arrays), known)
    except (*EXPECTED_ERRORS, *DAMAGED_ZIP) as error:
        raise LissomError(
            _("cannot write {path}, because Lissom could not open the file again: {error}").format(
                path=path, error=message_of(error)
            )
        ) from error
    _readable.update(document.layers)


def _read(archive: Archive, known: Mapping[int, Layer] = MappingProxyType({})) -> Document:
    content = _read_json(archive)
    schema = as_whole(content["schema"], "schema")
    if schema > SCHEMA:
        app_version = shortened(as_text(content.get("app_version", "?"), "app_version"))
        raise LissomError(_(NEWER_LISSOM).format(version=app_version, schema=schema, own=SCHEMA))
    if schema < 1:
        raise LissomError(
            _("it names the schema {schema}, which does not exist").format(schema=schema)
        )
    document = read_document(content, archive, known)
    attachments = {name: archive.read(name) for name in archive.unread if name != THUMBNAIL}
    return (
        replace(document, unknown_members=MappingProxyType(attachments))
        if attachments
        else document
    )


def _read_json(archive: Archive) -> JsonObject:
    text = archive.read(PROJECT_JSON, largest=LARGEST_JSON)
    # Each value but the first follows one of these marks. A decoded value takes some hundred bytes.
    if sum(text.count(mark) for mark in (b",", b"[", b"{")) > MOST_VALUES:
        raise LissomError(
            _("its project.json has too many values; a project has at most {most:,}").format(
                most=MOST_VALUES
            )
        )
    try:
        content = json.loads(
            text,
            object_pairs_hook=check_repeated_fields,
            parse_float=_finite,
            parse_constant=_finite,
        )
    except RecursionError:
        content = None
    except ValueError as error:
        raise LissomError(_("its project.json is not JSON: {error}").format(error=error)) from error
    if content is None or _is_deeper(content):
        raise LissomError(
            _("its project.json is nested deeper than {most} levels").format(most=DEEPEST)
        )
    return as_object(content, "project.json")


def _finite(text: str) -> float:
    number = float(text)
    if not isfinite(number):
        raise LissomError(
            _("its project.json contains {text}, which is not a finite number").format(text=text)
        )
    return number


def _is_deeper(content: object) -> bool:
    """Return whether lists and objects are nested too deeply for a project."""
    inside = [content] if isinstance(content, (dict, list)) else []
    for _level in range(DEEPEST + 1):
        inside = [
            value
            for each in inside
            for value in (each.values() if isinstance(each, dict) else each)
            if isinstance(value, (dict, list))
        ]
        if not inside:
            return False
    return True
