"""The bars around the panels: menus at the top, icons at the left, status at the bottom.

In: a session.
Out: actions.
Imports: `app.ui.style`, `app.ui.shortcuts`.
"""

from app.ui.bars.icons import draw_icon_bar as draw_icon_bar
from app.ui.bars.menus import draw_main_menu as draw_main_menu
from app.ui.bars.methods import draw_method_menu as draw_method_menu
from app.ui.bars.status import (
    describe_pose_limit as describe_pose_limit,
    draw_status_bar as draw_status_bar,
    list_status_items as list_status_items,
)
