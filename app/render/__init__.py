"""Drawing: the same renderer for the window and for offscreen frames.

In: a `Scene`, as values, and a `View`.
Out: pixels in a target.
Imports: `app.document`, `app.motion`, `app.storage`. Only this package and `app.render.gpu` use
OpenGL.
"""

from app.render.colormap import heat_colormap as heat_colormap
from app.render.drawn_mesh import (
    DrawnMesh as DrawnMesh,
    MemberMesh as MemberMesh,
    shader_is_faster as shader_is_faster,
)
from app.render.handles import (
    HandleMark as HandleMark,
    mark_anchor as mark_anchor,
    mark_handles as mark_handles,
)
from app.render.renderer import Renderer as Renderer
from app.render.scene import (
    TRANSPARENT as TRANSPARENT,
    Backdrop as Backdrop,
    Colour as Colour,
    Disc as Disc,
    Ghost as Ghost,
    Heat as Heat,
    Line as Line,
    Painted as Painted,
    Scene as Scene,
    Wireframe as Wireframe,
)
from app.render.thumbnails import (
    LayerPictures as LayerPictures,
    Thumbnail as Thumbnail,
    Thumbnails as Thumbnails,
)
from app.render.view import View as View, canvas_view as canvas_view, fit_view as fit_view
