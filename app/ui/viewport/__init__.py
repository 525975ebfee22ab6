"""The viewport: the drawing, its overlays, and the pointer's gestures on it.

In: the shown frame, and the pointer.
Out: a picture of the drawing, and gestures.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.render`.
"""

from app.ui.viewport import viewport as viewport
from app.ui.viewport.canvas import Canvas as Canvas, heat_limits as heat_limits
from app.ui.viewport.gpu_resources import measure_distortion as measure_distortion
from app.ui.viewport.interaction import joint_colour as joint_colour
from app.ui.viewport.marks import find_auto_pinned as find_auto_pinned
from app.ui.viewport.screen import ScreenMapping as ScreenMapping
from app.ui.viewport.split_view import SplitTextures as SplitTextures
