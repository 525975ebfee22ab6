"""How figures stand among each other: what they hang on, and when they are seen.

In: ids of figures, and frames.
Out: joints, switches and choices.
Imports: the values of `app.document`.
"""

from app.document.layering.attachment import (
    Attachment as Attachment,
    require_joints as require_joints,
)
from app.document.layering.sight import (
    Choice as Choice,
    Switch as Switch,
    Turn as Turn,
    require_in_order as require_in_order,
)
