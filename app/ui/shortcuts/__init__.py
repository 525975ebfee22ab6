"""What a person can do by name: one table, from which menus, buttons, tooltips and keys are made.

In: a session, and the keys that are pressed.
Out: actions.
Imports: `app.editor`, `app.ui.style`.
"""

from app.ui.shortcuts.binding import Binding as Binding
from app.ui.shortcuts.gestures import GESTURES as GESTURES
from app.ui.shortcuts.keys import (
    ALT as ALT,
    CTRL as CTRL,
    MODIFIERS as MODIFIERS,
    SHIFT as SHIFT,
    in_words as in_words,
    with_key as with_key,
)
from app.ui.shortcuts.pressed import ARROWS as ARROWS, pressed as pressed
from app.ui.shortcuts.table import BINDINGS as BINDINGS, MENUS as MENUS
from app.ui.shortcuts.widgets import (
    bound_button as bound_button,
    bound_item as bound_item,
    bound_text_button as bound_text_button,
)
