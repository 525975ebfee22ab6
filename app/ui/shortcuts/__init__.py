"""All named actions: one table makes menus, buttons, tooltips and shortcuts.

In: a session, and the pressed keys.
Out: actions.
Imports: `app.editor`, `app.ui.style`.
"""

from app.ui.shortcuts.action_spec import ActionSpec as ActionSpec
from app.ui.shortcuts.key_input import ARROWS as ARROWS, collect_key_actions as collect_key_actions
from app.ui.shortcuts.keys import (
    ALT as ALT,
    CTRL as CTRL,
    MODIFIERS as MODIFIERS,
    SHIFT as SHIFT,
    format_chord as format_chord,
    format_modified as format_modified,
)
from app.ui.shortcuts.pointer_help import POINTER_HELP as POINTER_HELP
from app.ui.shortcuts.table import BINDINGS as BINDINGS, MENUS as MENUS
from app.ui.shortcuts.widgets import (
    draw_action_button as draw_action_button,
    draw_action_item as draw_action_item,
    draw_action_text_button as draw_action_text_button,
)
