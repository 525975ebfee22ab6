"""How layers stand among each other: groups, what they hang on, when they are seen, and where.

In: ids of layers, and frames.
Out: groups, joints, switches and choices; keys of the camera, and of layers as a whole.
Imports: the values of `app.document`.
"""

from app.document.layering.attachment import (
    Attachment as Attachment,
    joints_repeat as joints_repeat,
    repeated_joints as repeated_joints,
    require_joints as require_joints,
)
from app.document.layering.groups import (
    BLENDS as BLENDS,
    DEEPEST as DEEPEST,
    GROUP_BLENDS as GROUP_BLENDS,
    BlendMode as BlendMode,
    Group as Group,
    GroupBlend as GroupBlend,
    paths_to as paths_to,
    require_path as require_path,
    shared_path as shared_path,
)
from app.document.layering.moves import (
    CameraKey as CameraKey,
    MoveKey as MoveKey,
    OpacityKey as OpacityKey,
    Placing as Placing,
    require_rising as require_rising,
)
from app.document.layering.sight import (
    Choice as Choice,
    Switch as Switch,
    Turn as Turn,
    require_in_order as require_in_order,
)
