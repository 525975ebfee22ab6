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
from app.editor.actions.posing.inserting import INSERTING, fit_pose, insert_key
from app.editor.actions.posing.pulling import (
    drop,
    free_turn,
    let_go,
    nudge,
    pin_here,
    pull,
    pull_again,
    wish,
    wishes_of,
)
from app.editor.actions.posing.settling import settle, tried_clips
from app.editor.actions.posing.steps import POSING, STEPS, accept, hold, retargeted
from app.editor.actions.posing.waiting import catch_up, forget, is_there, waits

__all__ = [
    "INSERTING",
    "POSING",
    "STEPS",
    "accept",
    "add_handle",
    "anchor_at",
    "catch_up",
    "drop",
    "fit_pose",
    "forget",
    "free_turn",
    "hold",
    "insert_key",
    "is_there",
    "let_go",
    "mirror_handles",
    "nudge",
    "pin_here",
    "pull",
    "pull_again",
    "put_anchor",
    "remove_handles",
    "retargeted",
    "settle",
    "suggest_handles",
    "tried_clips",
    "waits",
    "wish",
    "wishes_of",
]
