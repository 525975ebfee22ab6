"""Stiff and soft parts of a layer over its picture: colours, bones, and the brush."""

from math import log

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui
from scipy.spatial import cKDTree

from app.document import Layer, stiff_outline
from app.editor.actions.layer_setup import stiffness_editing
from app.motion import DeformMesh
from app.ui.style.drawing import outline_strokes
from app.ui.style.theme import Look, colour_u32
from app.ui.viewport.screen import ScreenMapping
from engine.arrays import Floats

EXTENT = log(stiffness_editing.STRONGEST)  # stiffness at the end of the colour scale
WIDEST, AT = 0.09, 0.2  # of a bone's length: half its width, and where it is widest
AROUND, TINY = 128, 1e-6  # nearest outline points of a vertex; least distance
MOST = 0.7  # em: half a bone's width at most


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


def draw_bones(look: Look, screen: ScreenMapping) -> None:
    """Draw the visible bones as thin diamonds from handle to handle."""
    shown = screen.shown
    handles = [handle.id for handle in shown.clip.layer.handles]
    places = dict(zip(handles, shown.handle_positions.tolist(), strict=True))
    for bone in screen.project.layer.bones:
        if bone.is_shown and places.keys() >= set(bone.ends):
            start, end = (screen.point(places[identity]) for identity in bone.ends)
            draw_bone(look, start, end, look.palette.text)


def draw_bone(look: Look, start: ImVec2, end: ImVec2, colour: ImVec4) -> None:
    way = complex(end.x - start.x, end.y - start.y)
    if not way:
        return
    aside = 1j * way / abs(way) * min(WIDEST * abs(way), MOST * look.em)
    middle = complex(start.x, start.y) + AT * way
    left, right = (ImVec2(at.real, at.imag) for at in (middle + aside, middle - aside))
    diamond = start, left, end, right
    draw_list = imgui.get_window_draw_list()
    draw_list.add_convex_poly_filled(list(diamond), colour_u32(colour, 0.3))
    for tone, width in outline_strokes(look, colour_u32(colour), 0.08):
        draw_list.add_polyline(list(diamond), tone, width, imgui.ImDrawFlags_.closed)
