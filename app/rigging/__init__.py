"""Bodies and how they move: joints of a drawing, motion presets, springs and recordings.

In: the outlines of a drawing, its joints by name, or places of a point at frames.
Out: suggested handles and joints; places of joints at each moment; a spring's offsets from a place;
few keys for a recording.
Imports: `engine`.
"""

from app.rigging.anatomy.handle_places import suggest_handles as suggest_handles
from app.rigging.anatomy.joints import suggest_joints as suggest_joints
from app.rigging.anatomy.kind_guess import guess_kind as guess_kind
from app.rigging.anatomy.lines.arm_lines import (
    find_arm_line as find_arm_line,
    with_shoulders as with_shoulders,
)
from app.rigging.anatomy.lines.leg_tracks import track_legs as track_legs
from app.rigging.anatomy.lines.limb_lines import (
    LimbLine as LimbLine,
    find_limb_line as find_limb_line,
)
from app.rigging.anatomy.lines.near_arms import (
    NearArm as NearArm,
    find_near_arm as find_near_arm,
    move_off_arm as move_off_arm,
    trace_near_arm as trace_near_arm,
    with_near_arm as with_near_arm,
)
from app.rigging.anatomy.lines.near_limbs import (
    NearLimb as NearLimb,
    guess_near_limbs as guess_near_limbs,
    name_near_limbs as name_near_limbs,
    swap_limbs as swap_limbs,
)
from app.rigging.anatomy.lines.tracked_joints import with_tracked_legs as with_tracked_legs
from app.rigging.kinematics.chains import bend_side as bend_side, solve_chain as solve_chain
from app.rigging.kinematics.recordings import FittedKeys as FittedKeys, fit_keys as fit_keys
from app.rigging.kinematics.spring_delay import find_spring_frequency as find_spring_frequency
from app.rigging.kinematics.springs import (
    FADE_FRAMES as FADE_FRAMES,
    SpringResponse as SpringResponse,
    frames_to_settle as frames_to_settle,
    simulate_spring as simulate_spring,
    turn_arm as turn_arm,
)
from app.rigging.motions.body import (
    Body as Body,
    other_side as other_side,
    without_side as without_side,
)
from app.rigging.motions.facing import guess_facing as guess_facing
from app.rigging.motions.kinds import (
    KINDS as KINDS,
    BodyKind as BodyKind,
    find_kind as find_kind,
    near_side as near_side,
)
from app.rigging.motions.library.table import MOTIONS as MOTIONS, find_motion as find_motion
from app.rigging.motions.motion import (
    FollowingJoint as FollowingJoint,
    Motion as Motion,
    MotionTemplate as MotionTemplate,
    Parameters as Parameters,
    Performance as Performance,
)
from app.rigging.motions.steps import bend_straight_legs as bend_straight_legs
from app.rigging.motions.timing import Timing as Timing
