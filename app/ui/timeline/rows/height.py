"""The height that the timeline wants: small for one layer, more with each row and lane."""

from app.editor import Project
from app.ui.timeline.layout import EVEN, SOUND, THIN

LEAST = 8.0  # em: with the row of a single layer
GRAPH = 22.0  # em: with the graph in place of the rows


def wanted_height(project: Project) -> float:
    """Return the height in em in which all rows, lanes and bands can be seen."""
    if project.graph.is_open:
        return GRAPH
    document, opened = project.document, project.timeline.expanded_layers
    rows = [EVEN if row.layer else THIN for row in project.tree]
    layers = (row.layer for row in project.tree if row.layer and row.layer.id in opened)
    lanes = sum(len(project.lanes_of(layer)) - 1 for layer in layers)
    # Not with the first marker: the ruler would move under the pointer that sets it.
    sounds = SOUND * len(document.sounds)
    return LEAST + sum(rows) - EVEN + (lanes + bool(document.camera)) * THIN + sounds
