"""How a deformation comes to rest: from certified map to certified map, to a minimum.

In: an objective, a certified map, and the way to search along.
Out: a search that is advanced step by step, how far it is from a minimum, and the active bounds.
Imports: `engine.maps`, and the energy, barrier, handles and Newton models of `engine.deform`.
"""

from engine.deform.rest.continuation import advance as advance, begin_search as begin_search
from engine.deform.rest.optimality import ActiveBound as ActiveBound
from engine.deform.rest.rungs import exceed_first_rung as exceed_first_rung
from engine.deform.rest.search import (
    MOST_STEPS as MOST_STEPS,
    OPTIMAL as OPTIMAL,
    WORTH_A_JUMP as WORTH_A_JUMP,
    Search as Search,
    Way as Way,
)
