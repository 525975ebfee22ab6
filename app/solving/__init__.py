"""Poses from handles: drags, keys that are solved again, and pose scripts.

In: a figure, and where handles are wanted.
Out: certified poses.
Imports: `app.motion`, `app.storage`.
"""

from app.solving.drag import Drag, Rig, pose_at
from app.solving.flipping import flip_poses, flipped_targets
from app.solving.renewal import Renewal, go_on
from app.solving.replacing import begin_replacing
from app.solving.script import load_pose_script
from app.solving.script_solver import pose_document

__all__ = [
    "Drag",
    "Renewal",
    "Rig",
    "begin_replacing",
    "flip_poses",
    "flipped_targets",
    "go_on",
    "load_pose_script",
    "pose_at",
    "pose_document",
]
