"""From a picture file to a new document."""

from pathlib import Path
from typing import NamedTuple

from app.document import Document, Meshing, PictureFile, new_figure
from app.storage.pictures import Picture, decode_picture, read_picture_file
from engine.domain import build_domain


class OpenedPicture(NamedTuple):
    """A new document, its decoded picture, and every remedy that was applied, in words."""

    document: Document
    picture: Picture
    notices: tuple[str, ...]


def open_picture(path: Path, meshing: Meshing) -> OpenedPicture:
    """Read a picture, find its outline, and return the document that shows it as it was drawn.

    Raises
    ------
    LissomError, EngineError
        If the file is no picture, or has no subject that can be outlined.
    """
    data = read_picture_file(path)
    picture = decode_picture(data, str(path))
    domain, remedies = build_domain(
        picture.rgba,
        triangles=meshing.triangles,
        detail=meshing.detail,
        tolerance=meshing.tolerance,
    )
    file = PictureFile(data=data, suffix=picture.suffix, size=picture.size)
    document = Document(figures=(new_figure(file, domain, meshing),))
    return OpenedPicture(document, picture, picture.notices + remedies)
