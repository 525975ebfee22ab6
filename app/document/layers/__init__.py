"""Relations and channels of layers: groups, attachments, visibility, switches, layer keys.

In: ids of layers, and frames.
Out: groups, attachments, visibility keys, switch groups; keys of the camera and of whole layers.
Imports: the values of `app.document`.
"""

from app.document.layers.attachments import (
    Attachment as Attachment,
    attachments_repeat as attachments_repeat,
    repeated_joints as repeated_joints,
    require_attachments as require_attachments,
)
from app.document.layers.groups import (
    BLENDS as BLENDS,
    GROUP_BLENDS as GROUP_BLENDS,
    MAX_GROUP_DEPTH as MAX_GROUP_DEPTH,
    BlendMode as BlendMode,
    Group as Group,
    GroupBlend as GroupBlend,
    ancestor_paths as ancestor_paths,
    common_path as common_path,
    require_path as require_path,
)
from app.document.layers.layer_keys import (
    CameraKey as CameraKey,
    DrawOrderKey as DrawOrderKey,
    OpacityKey as OpacityKey,
    TransformKey as TransformKey,
    require_ascending_keys as require_ascending_keys,
)
from app.document.layers.visibility import (
    SwitchGroup as SwitchGroup,
    SwitchKey as SwitchKey,
    VisibilityKey as VisibilityKey,
    require_ascending_visibility_keys as require_ascending_visibility_keys,
)
