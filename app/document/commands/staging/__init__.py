"""Commands on what is seen when, and on groups.

In: a document, and ids of its figures.
Out: the changed document.
Imports: the values of `app.document`, `app.document.commands.command`.
"""

from app.document.commands.staging import (
    choice_commands as choice_commands,
    group_commands as group_commands,
)
