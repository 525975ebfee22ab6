"""How a handle keeps its own time: whether it stays between keys, its track, what it follows.

In: the handle that is selected.
Out: actions on its track, its spring, and its stillness.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""

from app.ui.panels.handle_motion.auto_pin import draw_auto_pin as draw_auto_pin
from app.ui.panels.handle_motion.spring import draw_spring as draw_spring
from app.ui.panels.handle_motion.track import draw_track as draw_track
