"""Posing by handles: dragging, solving and committing poses.

In: a session, handles, and their targets.
Out: poses in the document, step by step; handles and the anchor.
Imports: `app.editor`, `app.document`, `app.motion`, `app.solving`.
"""

from app.editor.actions.posing.handles import (
    add_handle as add_handle,
    mirror_handles as mirror_handles,
    remove_handles as remove_handles,
    set_anchor as set_anchor,
    suggest_handles as suggest_handles,
    toggle_anchor_at_handle as toggle_anchor_at_handle,
)
from app.editor.actions.posing.inserting import (
    insert_key as insert_key,
    insert_key_at as insert_key_at,
    solve_nearest_pose as solve_nearest_pose,
)
from app.editor.actions.posing.pose_commit import (
    commit_targets as commit_targets,
    key_pose_command as key_pose_command,
)
from app.editor.actions.posing.pose_drag import (
    cancel_drag as cancel_drag,
    drag_handles as drag_handles,
    end_drag_at as end_drag_at,
    free_rotation as free_rotation,
    move_pose as move_pose,
    nudge_handles as nudge_handles,
    pin_selected_handles as pin_selected_handles,
    pose_at_playhead as pose_at_playhead,
    release_drag as release_drag,
    release_drag_forced as release_drag_forced,
    revert_drag as revert_drag,
    set_targets as set_targets,
    solve_pose_again as solve_pose_again,
)
from app.editor.actions.posing.pose_lifecycle import (
    candidate_clips as candidate_clips,
    commit_all_poses as commit_all_poses,
    update_pose_drags as update_pose_drags,
)
from app.editor.actions.posing.pose_solver import POSING as POSING, STEPS as STEPS
from app.editor.actions.posing.reach_limit import (
    clamp_unreachable_targets as clamp_unreachable_targets,
)
