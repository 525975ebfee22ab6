"""What a person can do: verbs that change the session, applied in one place.

In: a session, and the arguments of a verb.
Out: the session, changed; long work goes to the worker.
Imports: `app.editor`, and the rooms that do the work.
"""

from app.editor.actions import (
    cutting,
    editing,
    exporting,
    files,
    keys,
    playback,
    posing,
    rebuilding,
    saving,
    timeline_pointing,
    upkeep,
    viewing,
)
from app.editor.actions.viewing import (
    OverlayName,
    answer,
    browse,
    choose,
    close_dialog,
    dismiss,
    show_dialog,
    use_own_dialogs,
)

__all__ = [
    "OverlayName",
    "answer",
    "browse",
    "choose",
    "close_dialog",
    "cutting",
    "dismiss",
    "editing",
    "exporting",
    "files",
    "keys",
    "playback",
    "posing",
    "rebuilding",
    "saving",
    "show_dialog",
    "timeline_pointing",
    "upkeep",
    "use_own_dialogs",
    "viewing",
]
