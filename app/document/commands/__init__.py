"""Commands: changes of a document as values, with the words that undo and redo show.

In: a document, or a layer of it, and arguments.
Out: the changed document.
Imports: the values of `app.document`.
"""

from app.document.commands import (
    cycle_commands as cycle_commands,
    handle_commands as handle_commands,
    key_commands as key_commands,
    material_commands as material_commands,
    pose_commands as pose_commands,
    scene_commands as scene_commands,
    shape_commands as shape_commands,
    track_commands as track_commands,
)
from app.document.commands.command import (
    Command as Command,
    in_turn as in_turn,
    numbered as numbered,
)
from app.document.commands.pose_commands import (
    Settled as Settled,
    exchanged as exchanged,
    retargeted as retargeted,
)
from app.document.commands.staging import (
    choice_commands as choice_commands,
    filming_commands as filming_commands,
    group_commands as group_commands,
    layer_commands as layer_commands,
)
