"""Ready motions on drawings: joints become handles, and moments of a motion become keys.

In: a layer, where its joints are, and which motion it is given.
Out: the layer with its keys, and what of them is out of reach.
Imports: `app.document`, and the solver beside it.
"""

from app.solving.moving.giving import (
    Giving as Giving,
    begin_giving as begin_giving,
    give_on as give_on,
)
from app.solving.moving.joints_file import ToldJoints as ToldJoints, load_joints as load_joints
from app.solving.moving.order import (
    MotionOrder as MotionOrder,
    facing_in as facing_in,
)
