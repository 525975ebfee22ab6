"""Motion presets on drawings: joints become handles, and times of a motion become keys.

In: a layer, the places of its joints, and a motion preset.
Out: the layer with its keys, and its target errors.
Imports: `app.document`, and the solver beside it.
"""

from app.solving.motion_preset.joints_file import (
    JointsFile as JointsFile,
    load_joints as load_joints,
)
from app.solving.motion_preset.motion_request import (
    MotionRequest as MotionRequest,
    find_facing as find_facing,
)
from app.solving.motion_preset.motion_solve import (
    MotionSolve as MotionSolve,
    start_motion_solve as start_motion_solve,
    step_motion_solve as step_motion_solve,
)
