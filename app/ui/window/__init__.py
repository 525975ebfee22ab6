"""The window: its loop, its frame, and all panels.

In: the system's events.
Out: a running window.
Imports: every other room of `app.ui`.
"""

from app.ui.window.memory import limit_arenas as limit_arenas
from app.ui.window.window import Window as Window, has_display as has_display
