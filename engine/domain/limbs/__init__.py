"""The limbs of a shape: where handles are useful in it, and where the joints of a body may be.

In: the outline and the outlines of the holes.
Out: places for handles, and their names; what kind of body it looks like, and its joints.
Imports: `engine.geometry`, `engine.geometry.motions`, `engine.domain.meshing`.
"""

from engine.domain.limbs.handle_places import suggest_handles as suggest_handles
from engine.domain.limbs.joints import suggested_joints as suggested_joints
from engine.domain.limbs.kind_guess import guessed_kind as guessed_kind
from engine.domain.limbs.names import SuggestedHandle as SuggestedHandle
