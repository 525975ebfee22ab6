"""Posing by handles: what the hand pulls, and what the worker's solver makes of it.

In: a session, handles, and where they are wished.
Out: poses in the document, step by step; handles and the anchor.
Imports: `app.editor`, `app.document`, `app.motion`, `app.solving`.
"""

from app.editor.actions.posing.adopting import (
    adopt_wish as adopt_wish,
    as_key as as_key,
)
from app.editor.actions.posing.handles import (
    add_handle as add_handle,
    anchor_at as anchor_at,
    mirror_handles as mirror_handles,
    put_anchor as put_anchor,
    remove_handles as remove_handles,
    suggest_handles as suggest_handles,
)
from app.editor.actions.posing.inserting import (
    fit_pose as fit_pose,
    insert_key as insert_key,
    insert_key_at as insert_key_at,
)
from app.editor.actions.posing.pulling import (
    end_at as end_at,
    free_turn as free_turn,
    give_up as give_up,
    insist as insist,
    let_go as let_go,
    move as move,
    nudge as nudge,
    pin_here as pin_here,
    pose_here as pose_here,
    pull as pull,
    pull_again as pull_again,
    take_back as take_back,
    wish as wish,
)
from app.editor.actions.posing.settling import (
    bring_all as bring_all,
    maintain as maintain,
    tried_clips as tried_clips,
)
from app.editor.actions.posing.solving import POSING as POSING, STEPS as STEPS
from app.editor.actions.posing.stopping import give_in as give_in
