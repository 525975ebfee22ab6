"""The drawing, and everything that the pointer does to it.

In: what is shown, and the pointer.
Out: a picture of the drawing, and gestures.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.render`.
"""

from app.ui.viewport import viewport as viewport
from app.ui.viewport.canvas import Canvas as Canvas, heat_limits as heat_limits
from app.ui.viewport.drawing import measure as measure
from app.ui.viewport.hand import joint_colour as joint_colour
from app.ui.viewport.marks import staying as staying
from app.ui.viewport.screen import Screen as Screen
from app.ui.viewport.split_view import SplitTextures as SplitTextures
