"""Projects as a window has them, for the tests of the editor and of the window."""

from app.document import Document, History, clip_of
from app.editor import LayerRuntime, Project
from app.editor.parts.project_file import ProjectFile
from app.editor.parts.selection import Selection
from app.editor.work.layer_runtime import LayerRuntimes
from app.storage import Picture
from engine.arrays import Bytes


def project_of(document: Document, pixels: Bytes, name: str) -> Project:
    """A saved project of a document, whose pictures have these pixels; the first is posed."""
    picture = Picture(rgba=pixels, notices=())
    puppets = {
        layer.id: LayerRuntime.of(clip_of(document, layer.id), picture) for layer in document.layers
    }
    return Project(
        file=ProjectFile(name=name),
        history=History(document, saved=True),
        runtimes=LayerRuntimes(layers=puppets),
        selection=Selection(active=document.layers[0].id),
    )
