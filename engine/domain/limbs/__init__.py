"""The limbs of a shape, and where handles are useful in it.

In: the outline and the outlines of the holes.
Out: places for handles, and their names.
Imports: `engine.geometry`, `engine.domain.meshing`.
"""

from engine.domain.limbs.handle_places import suggest_handles as suggest_handles
from engine.domain.limbs.names import SuggestedHandle as SuggestedHandle
