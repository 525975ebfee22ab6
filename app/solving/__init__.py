"""Poses from handles: drags, keys that are solved again, pose scripts and ready motions.

In: a layer, and where handles are wanted.
Out: certified poses.
Imports: `app.motion`, `app.storage`.
"""

from app.solving.carrying import Carriage as Carriage, Likeness as Likeness
from app.solving.drag import Drag as Drag, Rig as Rig, pose_at as pose_at
from app.solving.flipping import flip_poses as flip_poses, flipped_targets as flipped_targets
from app.solving.moving import (
    Giving as Giving,
    MotionOrder as MotionOrder,
    ToldJoints as ToldJoints,
    begin_giving as begin_giving,
    facing_in as facing_in,
    give_on as give_on,
    load_joints as load_joints,
)
from app.solving.renewal import Renewal as Renewal, go_on as go_on
from app.solving.replacing import begin_replacing as begin_replacing
from app.solving.script import load_pose_script as load_pose_script
from app.solving.script_solver import pose_document as pose_document
