"""The window itself: its loop, its frame, and the panels put together.

In: the system's events.
Out: a running window.
Imports: every other room of `app.ui`.
"""

from app.ui.window.memory import share_heap as share_heap
from app.ui.window.window import Window as Window, has_display as has_display
