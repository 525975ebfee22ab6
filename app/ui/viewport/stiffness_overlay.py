"""The colours of stiff and soft parts of a layer."""

from math import log

import numpy as np
from scipy.spatial import cKDTree

from app.document import Layer, stiff_outline
from app.editor.actions.layer_setup import stiffness_editing
from app.motion import DeformMesh
from engine.arrays import Floats

EXTENT = log(stiffness_editing.STRONGEST)  # stiffness at the end of the colour scale
AROUND, TINY = 128, 1e-6  # nearest outline points of a vertex; least distance


def measure_vertex_stiffness(layer: Layer, mesh: DeformMesh) -> Floats:
    """Return the stiffness of a mesh's vertices, (v,), −1 to 1, from the outline near each."""
    along, stiffness = stiff_outline(layer)
    values, vertices = np.log(stiffness) / EXTENT, mesh.domain.mesh.vertices
    tree = cKDTree(np.column_stack([along.real, along.imag]))
    away, nearest = tree.query(
        np.column_stack([vertices.real, vertices.imag]), k=range(1, min(AROUND, len(along)) + 1)
    )
    weights = 1.0 / np.maximum(away, TINY * np.max(away)) ** 3
    tinted: Floats = (weights * values[nearest]).sum(axis=1) / weights.sum(axis=1)
    return tinted
