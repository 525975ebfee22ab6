"""Motion presets: cycles of joint motion, independent of the body.

In: the joints of a drawing by name, and a motion with its parameters.
Out: the position of each joint at each moment.
Imports: `engine.arrays`, `engine.errors`.
"""

from engine.geometry.motions.body import Body as Body, other_side as other_side
from engine.geometry.motions.catalogue import find_motion as find_motion
from engine.geometry.motions.facing import guess_facing as guess_facing
from engine.geometry.motions.kinds import (
    KINDS as KINDS,
    BodyKind as BodyKind,
    find_kind as find_kind,
)
from engine.geometry.motions.library import MOTIONS as MOTIONS
from engine.geometry.motions.motion import (
    JointPose as JointPose,
    Motion as Motion,
    Parameters as Parameters,
)
