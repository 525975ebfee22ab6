"""What surrounds the panels: menus above, icons at the left, the status below.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""

from app.ui.bars.icons import draw_icons as draw_icons
from app.ui.bars.menus import draw_menu as draw_menu
from app.ui.bars.methods import draw_methods as draw_methods
from app.ui.bars.status import (
    draw_status as draw_status,
    facts as facts,
    limit_of_pose as limit_of_pose,
)
