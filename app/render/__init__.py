"""Drawing: the same renderer for the window and without one.

In: a `Scene`, as values, and a `View`.
Out: pixels in a target.
Imports: `app.motion`, `app.storage`; with `app.render.gpu` it alone sees OpenGL.
"""

from app.render.draw_lists import DrawLists, Textures
from app.render.drawn_mesh import DrawnMesh, shader_is_faster
from app.render.handles import HandleMark, HandleStyle, mark_anchor, mark_handles
from app.render.ramp import heat_ramp
from app.render.renderer import Renderer
from app.render.scene import (
    TRANSPARENT,
    Backdrop,
    Colour,
    Disc,
    Ghost,
    Heat,
    Line,
    Scene,
    Wireframe,
)
from app.render.thumbnails import LayerPictures, Thumbnail, Thumbnails
from app.render.view import View, canvas_view, fit_view

__all__ = [
    "TRANSPARENT",
    "Backdrop",
    "Colour",
    "Disc",
    "DrawLists",
    "DrawnMesh",
    "Ghost",
    "HandleMark",
    "HandleStyle",
    "Heat",
    "LayerPictures",
    "Line",
    "Renderer",
    "Scene",
    "Textures",
    "Thumbnail",
    "Thumbnails",
    "View",
    "Wireframe",
    "canvas_view",
    "fit_view",
    "heat_ramp",
    "mark_anchor",
    "mark_handles",
    "shader_is_faster",
]
