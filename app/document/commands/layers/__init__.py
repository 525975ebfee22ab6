"""Commands on layers: order, groups, attachments, switch groups, visibility and channels.

In: a document, and ids of its layers.
Out: the changed document.
Imports: the values of `app.document`, commands on handles and keys.
"""

from app.document.commands.layers import (
    filming_commands as filming_commands,
    group_commands as group_commands,
    layer_commands as layer_commands,
    switch_group_commands as switch_group_commands,
)
