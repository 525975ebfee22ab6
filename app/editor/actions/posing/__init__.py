"""Posing by handles: what the hand pulls, and what the worker's solver makes of it.

In: a session, handles, and where they are wished.
Out: poses in the document, step by step; handles and the anchor.
Imports: `app.editor`, `app.document`, `app.motion`, `app.solving`.
"""

from app.editor.actions.posing.handles import (
    add_handle,
    anchor_at,
    mirror_handles,
    put_anchor,
    remove_handles,
    suggest_handles,
)
from app.editor.actions.posing.inserting import INSERTING, fit_pose, insert_key, insert_key_at
from app.editor.actions.posing.keeping import holding, retargeted
from app.editor.actions.posing.pulling import (
    end_at,
    free_turn,
    give_up,
    let_go,
    nudge,
    pin_here,
    pull,
    pull_again,
    take_back,
    wish,
)
from app.editor.actions.posing.settling import bring_all, keep_up, tried_clips
from app.editor.actions.posing.solving import POSING, STEPS

__all__ = [
    "INSERTING",
    "POSING",
    "STEPS",
    "add_handle",
    "anchor_at",
    "bring_all",
    "end_at",
    "fit_pose",
    "free_turn",
    "give_up",
    "holding",
    "insert_key",
    "insert_key_at",
    "keep_up",
    "let_go",
    "mirror_handles",
    "nudge",
    "pin_here",
    "pull",
    "pull_again",
    "put_anchor",
    "remove_handles",
    "retargeted",
    "suggest_handles",
    "take_back",
    "tried_clips",
    "wish",
]
