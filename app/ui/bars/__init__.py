"""What surrounds the panels: menus above, icons at the left, the status below.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""

from app.ui.bars.icons import draw_icons
from app.ui.bars.menus import draw_menus
from app.ui.bars.status import draw_status, facts, hold_back

__all__ = ["draw_icons", "draw_menus", "draw_status", "facts", "hold_back"]
