"""The footage of layers in a project file: files named relative to the project's folder."""

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path, PurePath

from app.document import Document, Footage, Layer
from app.storage.project.codecs import NUMBER, TEXT, WHOLE, Field, list_of, pair, record
from app.texts import N_

FOOTAGE = record(
    Footage,
    Field("name", TEXT),
    Field("folder", TEXT),
    Field("files", list_of(TEXT)),
    Field("size", pair(WHOLE, WHOLE, N_("two whole numbers"))),
    Field("fps", NUMBER),
    Field("picture_count", WHOLE),
    Field("holds", list_of(WHOLE), default=()),
)


def footage_relative_to(document: Document, folder: Path) -> Document:
    """Return a document as it is written to a folder: folders of footage are relative to it."""

    def relative(given: str) -> str:
        try:
            return PurePath(os.path.relpath(given, folder.absolute())).as_posix()
        except ValueError:  # on another drive
            return given

    return _with_folders(document, relative)


def footage_found_from(document: Document, folder: Path) -> Document:
    """Return a document as it was read from a folder: folders of footage are absolute."""
    return _with_folders(document, lambda given: os.path.normpath(folder.absolute() / given))


def _with_folders(document: Document, change: Callable[[str], str]) -> Document:
    def changed(layer: Layer) -> Layer:
        footage = layer.footage
        if footage is None:
            return layer
        return replace(layer, footage=replace(footage, folder=change(footage.folder)))

    if all(layer.footage is None for layer in document.layers):
        return document
    return replace(document, layers=tuple(map(changed, document.layers)))
