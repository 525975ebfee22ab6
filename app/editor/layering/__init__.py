"""What a person does with layers: choosing, ordering, hiding, replacing, joining them.

In: a session, and the ids of figures.
Out: other figures, or others in another order; which of them is posed.
Imports: `app.editor`, `app.document`, `app.motion`, `app.solving`, `app.storage`.
"""

from app.editor.layering.arranging import (
    ask_name,
    choose,
    duplicate,
    fade,
    figure_at,
    is_at,
    list_active,
    lock,
    move,
    refer,
    remove,
    rename,
    show,
    switch_here,
    tint_depth,
    unswitch_here,
)
from app.editor.layering.hanging import hang, hangs_on, let_hang, turn_with
from app.editor.layering.pictures import (
    add,
    ask,
    ask_replace,
    drop,
    point_at,
    replace_picture,
    stand_still,
    stand_up,
)

__all__ = [
    "add",
    "ask",
    "ask_name",
    "ask_replace",
    "choose",
    "drop",
    "duplicate",
    "fade",
    "figure_at",
    "hang",
    "hangs_on",
    "is_at",
    "let_hang",
    "list_active",
    "lock",
    "move",
    "point_at",
    "refer",
    "remove",
    "rename",
    "replace_picture",
    "show",
    "stand_still",
    "stand_up",
    "switch_here",
    "tint_depth",
    "turn_with",
    "unswitch_here",
]
