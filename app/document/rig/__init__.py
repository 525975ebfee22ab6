"""Relations of handles: mirror pairs, bones and stiffness, and applied motion presets.

In: handles.
Out: mirror partners, bones, stiffness, applied motion presets.
Imports: the values of `app.document`.
"""

from app.document.rig.applied_motion import (
    AppliedMotion as AppliedMotion,
    UnreadMotion as UnreadMotion,
    require_motions as require_motions,
)
from app.document.rig.mirror_names import (
    PAIRS as PAIRS,
    SIDES as SIDES,
    SidePairs as SidePairs,
    format_pairs as format_pairs,
    mirrored_handles as mirrored_handles,
    mirrored_handles_by_name as mirrored_handles_by_name,
    mirrored_name as mirrored_name,
    parse_pairs as parse_pairs,
    require_pairs as require_pairs,
)
from app.document.rig.stiffness import (
    DEFAULT_BONE_STIFFNESS as DEFAULT_BONE_STIFFNESS,
    Bone as Bone,
    combined_stiffness as combined_stiffness,
    default_as_none as default_as_none,
    require_stiffness_amount as require_stiffness_amount,
    transfer_painted_stiffness as transfer_painted_stiffness,
)
