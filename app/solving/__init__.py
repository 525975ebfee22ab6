"""Poses from targets: drags, repeated solving of keys, pose scripts and motion presets.

In: a layer, and targets of handles.
Out: certified poses.
Imports: `app.motion`, `app.storage`.
"""

from app.solving.deform_group.bending import (
    BendingAsOne as BendingAsOne,
    bend_as_one as bend_as_one,
)
from app.solving.deform_group.rebuilding import (
    part_deform_group as part_deform_group,
    replace_member_picture as replace_member_picture,
)
from app.solving.deform_group.suggestion import suggest_deform_groups as suggest_deform_groups
from app.solving.drag.drag_solver import DragSolver as DragSolver
from app.solving.drag.rig import Rig as Rig
from app.solving.drag.shown_pose import fit_shown_pose as fit_shown_pose
from app.solving.flipping import flip_poses as flip_poses, flip_targets as flip_targets
from app.solving.motion_preset.body_rig import rig_body as rig_body
from app.solving.motion_preset.joint_guess import (
    JointGuess as JointGuess,
    guess_joints as guess_joints,
    guess_layer_kind as guess_layer_kind,
)
from app.solving.motion_preset.joints_file import (
    JointsFile as JointsFile,
    find_joints as find_joints,
    load_joints as load_joints,
)
from app.solving.motion_preset.limb_cuts import (
    PARTED as PARTED,
    find_limb_cuts as find_limb_cuts,
)
from app.solving.motion_preset.motion_request import (
    MotionRequest as MotionRequest,
    find_facing as find_facing,
    find_rest_body as find_rest_body,
)
from app.solving.motion_preset.motion_solve import (
    MotionSolve as MotionSolve,
    start_motion_solve as start_motion_solve,
    step_motion_solve as step_motion_solve,
)
from app.solving.pose_transfer import (
    PoseTransfer as PoseTransfer,
    SimilarityTransform as SimilarityTransform,
)
from app.solving.reload.alignment import PlacedPicture as PlacedPicture
from app.solving.reload.apply import (
    Reloading as Reloading,
    start_reload as start_reload,
    step_reload as step_reload,
)
from app.solving.reload.margin import extend_under as extend_under
from app.solving.reload.plan import (
    Change as Change,
    LayerChange as LayerChange,
    ReloadPlan as ReloadPlan,
    find_drawing as find_drawing,
    plan_reload as plan_reload,
)
from app.solving.reload.replace_picture import (
    distance_notices as distance_notices,
    find_new_corner as find_new_corner,
    start_picture_replacement as start_picture_replacement,
)
from app.solving.reload.table import (
    ReloadRow as ReloadRow,
    reload_lines as reload_lines,
    reload_rows as reload_rows,
    scene_changes as scene_changes,
)
from app.solving.resolve_keys import KeyResolver as KeyResolver, step_resolver as step_resolver
from app.solving.script.pose_script import load_pose_script as load_pose_script
from app.solving.script_solver import pose_document as pose_document
