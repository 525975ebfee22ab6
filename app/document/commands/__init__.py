"""Commands: changes of a document as values, with labels for undo and redo.

In: a document, or a layer of it, and arguments.
Out: the changed document.
Imports: the values of `app.document`.
"""

from app.document.commands import (
    cycle_commands as cycle_commands,
    handle_commands as handle_commands,
    key_commands as key_commands,
    pose_commands as pose_commands,
    scene_commands as scene_commands,
    shape_commands as shape_commands,
    stiffness_commands as stiffness_commands,
    track_commands as track_commands,
)
from app.document.commands.command import (
    Command as Command,
    combine_commands as combine_commands,
    with_number as with_number,
)
from app.document.commands.layers import (
    filming_commands as filming_commands,
    group_commands as group_commands,
    layer_commands as layer_commands,
    switch_group_commands as switch_group_commands,
)
from app.document.commands.pose_commands import (
    PoseReplacement as PoseReplacement,
    with_all_targets as with_all_targets,
    with_replaced_pose as with_replaced_pose,
)
