"""Ready motions on drawings: joints become handles, and moments of a motion become keys.

In: a layer, where its joints are, and which motion it is given.
Out: the layer with its keys, and what of them is out of reach.
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
