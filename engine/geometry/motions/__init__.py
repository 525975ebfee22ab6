"""Ready motions: what a body does over a cycle, for whatever body it is.

In: the joints of a drawing by name, and a motion with its parameters.
Out: where each joint is at each moment.
Imports: `engine.arrays`, `engine.errors`.
"""

from engine.geometry.motions.body import Body as Body, other_side as other_side
from engine.geometry.motions.catalogue import motion_named as motion_named
from engine.geometry.motions.facing import facing_of as facing_of
from engine.geometry.motions.kinds import (
    KINDS as KINDS,
    BodyKind as BodyKind,
    kind_named as kind_named,
)
from engine.geometry.motions.library import MOTIONS as MOTIONS
from engine.geometry.motions.motion import (
    Motion as Motion,
    Parameters as Parameters,
    Posture as Posture,
)
