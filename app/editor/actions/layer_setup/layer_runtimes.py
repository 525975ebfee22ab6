"""Runtimes of the layers, as many as the document has layers."""

from app.editor.project import Project


def update_layer_runtimes(project: Project) -> None:
    """Match the layer runtimes and the selection to the layers of the document."""
    project.runtimes.match(project.document, project.history)
    project.selection.keep_existing(project.document)
