"""A search for the minimum: where it is, and when it is over."""

from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from engine.arrays import Floats
from engine.deform.handles import Handles, Wish
from engine.deform.model import Walls
from engine.deform.rest.opening import room
from engine.deform.rest.optimality import Optimality
from engine.maps import Boundary, Certificate, HarmonicMap, Limits

# Expected gain and complementarity, over the energy: a minimum.
OPTIMAL = 1e-6
# A search from elsewhere must gain this part of the energy: less is not worth a jump.
WORTH_A_JUMP = 1e-3
# What a search could still gain is an estimate that holds below this part of the energy.
RELIED_ON = 0.03
# Steps before all searches for one wish are given up, and before the one from the present map is
# put off, which is near rest or caught by bounds.
MOST_STEPS = 150
MOST_STEPS_HERE = 60
# Steps in a row that are hardly taken: the search is caught.
MOST_CAUGHT = 12


class Way(Enum):
    """Where a search for the minimum starts."""

    HERE = "from the present map"
    REST = "from the shape at rest"
    OPENING = "from the shape at rest, within bounds that open on the way"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Search:
    """A search for the minimum, on its way.

    Parameters
    ----------
    handles : Handles
    wish : Wish
    way : Way
    map : HarmonicMap
    certificate : Certificate
    boundary : Boundary
        With the samples that were added.
    limits : Limits
        What the certificates are for.
    inside : Limits
        Where the walls of the shape's own samples stand in the end.
    reach : float
        Of the rung that the walls stand on (`opening.room`).
    walls : Walls
    weight : float
        Of the barrier.
    duals : float64, shape (3, m), or None
    energy : float
        Of the map with its handles, at the whole wish.
    steps : int
    length : float
        Part of the last step that was taken.
    gain : float
        What the model expected of it.
    refusals : int
        Maps of the last step that were not certified.
    caught : int
        Steps in a row that were hardly taken.
    optimality : Optimality
    rival : float
        The energy that other ways have found: a search that cannot win is given up.
    before : int
        The steps of those ways.
    """

    handles: Handles
    wish: Wish
    way: Way
    map: HarmonicMap
    certificate: Certificate
    boundary: Boundary
    limits: Limits
    inside: Limits
    reach: float
    walls: Walls
    weight: float
    energy: float
    duals: Floats | None = None
    steps: int = 0
    length: float = 1.0
    gain: float = np.inf
    refusals: int = 0
    caught: int = 0
    optimality: Optimality = field(default_factory=Optimality)
    rival: float = np.inf
    before: int = 0

    @property
    def room(self) -> Limits:
        """Where the walls of the shape's own samples stand now."""
        return room(self.inside, self.reach)

    @property
    def is_open(self) -> bool:
        """Whether the walls stand where they will in the end."""
        return self.room == self.inside

    @property
    def has_arrived(self) -> bool:
        """Whether the map is a minimum."""
        return self.is_open and self.optimality.measure <= OPTIMAL

    @property
    def is_over(self) -> bool:
        """Whether the search found a minimum, or is given up."""
        here_first = self.way is Way.HERE and self.before == 0
        most = MOST_STEPS_HERE if here_first else MOST_STEPS - self.before
        return (
            self.has_arrived or self.steps >= most or self.caught >= MOST_CAUGHT or self._cannot_win
        )

    @property
    def _cannot_win(self) -> bool:
        """Whether another way has found less energy than this one can come to."""
        low_enough, gap = (1.0 - WORTH_A_JUMP) * self.rival, self.optimality.gap
        relied_on = self.is_open and gap < RELIED_ON * self.energy
        return relied_on and self.energy - gap > low_enough
