"""How a deformation comes to rest: from certified map to certified map, to a minimum.

In: an objective, a certified map, and the way to search along.
Out: a search that is advanced step by step, how far it is from a minimum, and the active bounds.
Imports: `engine.maps`, and the energy, barrier, handles and Newton models of `engine.deform`.
"""

from engine.deform.rest.continuation import advance, begin_search
from engine.deform.rest.opening import opens
from engine.deform.rest.optimality import ActiveBound
from engine.deform.rest.search import MOST_STEPS, OPTIMAL, WORTH_A_JUMP, Search, Way

__all__ = [
    "MOST_STEPS",
    "OPTIMAL",
    "WORTH_A_JUMP",
    "ActiveBound",
    "Search",
    "Way",
    "advance",
    "begin_search",
    "opens",
]
