"""Commands: changes of a document as values, with the words that undo and redo show.

In: a document, or a figure of it, and arguments.
Out: the changed document.
Imports: the values of `app.document`.
"""

from app.document.commands import (
    figure_commands,
    handle_commands,
    key_commands,
    layer_commands,
    pose_commands,
    scene_commands,
)
from app.document.commands.command import Command
from app.document.commands.pose_commands import Settled, exchanged

__all__ = [
    "Command",
    "Settled",
    "exchanged",
    "figure_commands",
    "handle_commands",
    "key_commands",
    "layer_commands",
    "pose_commands",
    "scene_commands",
]
