"""The search for the minimum: from certified map to certified map.

In: an objective, a certified map, and a starting point.
Out: a search that is advanced step by step, its optimality measure, and the active bounds.
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
