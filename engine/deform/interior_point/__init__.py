"""How a deformation comes to rest: from certified map to certified map, to a minimum.

In: an objective, a certified map, and the way to search along.
Out: a search that is advanced step by step, how far it is from a minimum, and the active bounds.
Imports: `engine.maps`, and the energy, barrier, handles and Newton models of `engine.deform`.
"""

from engine.deform.interior_point.continuation import (
    advance_search as advance_search,
    begin_search as begin_search,
)
from engine.deform.interior_point.homotopy import exceed_first_level as exceed_first_level
from engine.deform.interior_point.optimality import ActiveBound as ActiveBound
from engine.deform.interior_point.search import (
    MOST_STEPS as MOST_STEPS,
    OPTIMAL as OPTIMAL,
    WORTH_A_JUMP as WORTH_A_JUMP,
    Search as Search,
    StartingPoint as StartingPoint,
)
