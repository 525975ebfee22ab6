"""What a person can do by name: one table, from which menus, buttons, tooltips and keys are made.

In: a session, and the keys that are pressed.
Out: actions.
Imports: `app.editor`, `app.ui.style`.
"""

from app.ui.shortcuts.binding import Binding
from app.ui.shortcuts.gestures import GESTURES
from app.ui.shortcuts.keys import MODIFIERS, in_words, with_key
from app.ui.shortcuts.pressed import ARROWS, pressed
from app.ui.shortcuts.table import BINDINGS, MENUS
from app.ui.shortcuts.widgets import bound_button, bound_item, bound_text_button

__all__ = [
    "ARROWS",
    "BINDINGS",
    "GESTURES",
    "MENUS",
    "MODIFIERS",
    "Binding",
    "bound_button",
    "bound_item",
    "bound_text_button",
    "in_words",
    "pressed",
    "with_key",
]
