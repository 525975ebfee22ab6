"""The window itself: its loop, its frame, and the panels put together.

In: the system's events.
Out: a running window, or one without a display.
Imports: every other room of `app.ui`.
"""

from app.ui.window.memory import share_heap
from app.ui.window.offscreen import Offscreen
from app.ui.window.window import PAUSE, SIZE, Window, has_display

__all__ = ["PAUSE", "SIZE", "Offscreen", "Window", "has_display", "share_heap"]
