"""Pose scripts: animations in a small JSON format.

In: the file.
Out: the checked contents by layer.
Imports: `app.document`, `app.storage`.
"""

from app.solving.script.layers import ScriptAttachment as ScriptAttachment
from app.solving.script.pose_script import (
    LayerScript as LayerScript,
    PoseKey as PoseKey,
    PoseScript as PoseScript,
    ScriptHandle as ScriptHandle,
    load_pose_script as load_pose_script,
    parse_pose_script as parse_pose_script,
)
