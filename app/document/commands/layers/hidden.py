"""Showing a hidden layer."""

from dataclasses import replace

from app.document.layers.groups import ancestor_paths
from app.document.model import Document


def with_layer_shown(document: Document, identity: int) -> Document:
    """Return a document in which neither the layer nor a group around it is hidden.

    The other members of these groups become hidden themselves, so that only the layer appears.
    """
    layer = document.layer(identity)
    around = ancestor_paths(layer.group)
    hidden = {path for path in around if document.group(path).hidden}
    if not (hidden or layer.hidden):
        return document

    def was_hidden(path: str) -> bool:
        """Return whether members of this group were hidden by a group that is now shown."""
        return path in around and not hidden.isdisjoint(ancestor_paths(path))

    layers = tuple(
        replace(each, hidden=each is not layer) if each is layer or was_hidden(each.group) else each
        for each in document.layers
    )
    groups = tuple(
        replace(group, hidden=False)
        if group.name in hidden
        else replace(group, hidden=True)
        if group.name not in around and was_hidden(group.name.rpartition("/")[0])
        else group
        for group in document.groups
    )
    return replace(document, layers=layers, groups=groups)
