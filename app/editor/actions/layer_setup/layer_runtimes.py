"""Runtimes of the layers, as many as the document has layers."""

from app.document import clip_of
from app.editor.project import Project
from app.editor.work.layer_runtime import LayerRuntime
from app.storage import decode_picture


def update_layer_runtimes(project: Project) -> None:
    """Match the layer runtimes to the layers of the document."""
    document = project.document
    gone = project.layer_runtimes.keys() - {layer.id for layer in document.layers}
    for identity in gone:
        del project.layer_runtimes[identity]
    # Runtimes of layers that undo and redo may bring back are kept as well.
    spare = project.pictures.keys() - {layer.picture for layer in document.layers}
    for file in spare - project.history.picture_files if spare else ():
        del project.pictures[file]
    for layer in document.layers:
        runtime = project.layer_runtimes.get(layer.id)
        if runtime is not None and runtime.file is layer.picture:
            project.pictures[layer.picture] = runtime.picture
            continue
        if layer.picture not in project.pictures:
            decoded = decode_picture(layer.picture.data, layer.name)
            project.pictures[layer.picture] = decoded
        picture = project.pictures[layer.picture]
        project.layer_runtimes[layer.id] = LayerRuntime.of(
            clip_of(document, layer.id), picture, among=len(document.layers)
        )
    project.selection.keep_existing(document)
