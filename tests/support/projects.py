"""Projects as a window has them, for the tests of the editor and of the window."""

from app.document import Document, History, clip_of
from app.editor import Project, Puppet
from app.motion import Motion, PosableMesh
from app.storage import Picture
from engine.arrays import Bytes


def project_of(document: Document, pixels: Bytes, name: str) -> Project:
    """A saved project of a document with one figure, whose picture has these pixels."""
    (figure,) = document.figures
    puppet = Puppet(
        picture=Picture(rgba=pixels, notices=()),
        is_opaque=True,
        coarse=Motion.at_rest(clip_of(document, figure.id), PosableMesh.coarse(figure.domain)),
    )
    return Project(
        name=name,
        history=History(document, saved=True),
        path=None,
        puppets={figure.id: puppet},
        active=figure.id,
    )
