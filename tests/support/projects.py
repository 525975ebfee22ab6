"""Projects as a window has them, for the tests of the editor and of the window."""

from app.document import Document, History, clip_of
from app.editor import Project, Puppet
from app.storage import Picture
from engine.arrays import Bytes


def project_of(document: Document, pixels: Bytes, name: str) -> Project:
    """A saved project of a document with one figure, whose picture has these pixels."""
    (figure,) = document.figures
    puppet = Puppet.of(clip_of(document, figure.id), Picture(rgba=pixels, notices=()))
    return Project(
        name=name,
        history=History(document, saved=True),
        path=None,
        puppets={figure.id: puppet},
        active=figure.id,
    )
