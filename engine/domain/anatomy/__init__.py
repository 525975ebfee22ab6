"""Anatomy of a shape: suggested handles, and suggested joints of a body.

In: the outline and the outlines of the holes.
Out: places for handles, and their names; the kind of body, and its joints.
Imports: `engine.geometry`, `engine.geometry.motions`, `engine.domain.meshing`.
"""

from engine.domain.anatomy.handle_places import suggest_handles as suggest_handles
from engine.domain.anatomy.joints import suggest_joints as suggest_joints
from engine.domain.anatomy.kind_guess import guess_kind as guess_kind
from engine.domain.anatomy.names import SuggestedHandle as SuggestedHandle
