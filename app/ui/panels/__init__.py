"""The panels: each `draw_…` function reads the session and returns the person's actions.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`, `app.ui.viewport`.
"""

from app.ui.panels import (
    deform as deform,
    distortion as distortion,
    export as export,
    handle as handle,
    layers as layers,
    motion_preset as motion_preset,
    poses as poses,
)
