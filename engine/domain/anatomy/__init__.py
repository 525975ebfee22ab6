"""The limbs of a shape: where handles are useful in it, and where the joints of a body may be.

In: the outline and the outlines of the holes.
Out: places for handles, and their names; what kind of body it looks like, and its joints.
Imports: `engine.geometry`, `engine.geometry.motions`, `engine.domain.meshing`.
"""

from engine.domain.anatomy.handle_places import suggest_handles as suggest_handles
from engine.domain.anatomy.joints import suggest_joints as suggest_joints
from engine.domain.anatomy.kind_guess import guess_kind as guess_kind
from engine.domain.anatomy.names import SuggestedHandle as SuggestedHandle
