"""The ruler with frames, playhead, markers, camera row, and range ends.

In: the bands of the timeline.
Out: actions on time.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.ui.timeline.layout`.
"""

from app.ui.timeline.ruler.camera import draw_camera_row as draw_camera_row
from app.ui.timeline.ruler.edges import draw_range_edges as draw_range_edges
from app.ui.timeline.ruler.markers import draw_markers as draw_markers
from app.ui.timeline.ruler.ruler import (
    draw_overview as draw_overview,
    draw_playhead as draw_playhead,
    draw_ruler as draw_ruler,
)
