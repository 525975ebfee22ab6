"""Ready motions: what kind of body it is, where its joints are, and what it is to do.

In: the layer that is posed, and the motion that is drafted for it.
Out: actions on these.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.ui.viewport`.
"""

from app.ui.panels.motion_preset.tab import draw_motion_panel as draw_motion_panel
