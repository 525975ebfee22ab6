"""The deformer: handles, energy, barrier and Newton steps (Chen and Weber 2015, 2017).

In: a certified map, handles, and where they are wanted.
Out: certified maps whose handles are nearer, with status and statistics.
Imports: `engine.maps`, `engine.geometry`.
"""

from engine.deform.deformer import Deformer
from engine.deform.handles import Handles, Wish
from engine.deform.newton import line_search, newton_direction
from engine.deform.objective import Objective
from engine.deform.rest import ActiveBound
from engine.deform.state import State, Statistics, Status

__all__ = [
    "ActiveBound",
    "Deformer",
    "Handles",
    "Objective",
    "State",
    "Statistics",
    "Status",
    "Wish",
    "line_search",
    "newton_direction",
]
