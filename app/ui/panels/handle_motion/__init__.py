"""The motion of a single handle: auto-pin, track, spring.

In: the selected handle.
Out: actions on its track, its spring, and its auto-pin.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""

from app.ui.panels.handle_motion.auto_pin import draw_auto_pin as draw_auto_pin
from app.ui.panels.handle_motion.spring import draw_spring as draw_spring
from app.ui.panels.handle_motion.track import draw_track as draw_track
