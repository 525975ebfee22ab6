"""A search for the minimum: where it is, and when it is over."""

from dataclasses import dataclass, field
from enum import Enum
from math import pi

import numpy as np

from engine.arrays import Floats
from engine.deform.handles import Handles, HandleTargets
from engine.deform.interior_point.homotopy import are_same_bounds, homotopy_level
from engine.deform.interior_point.optimality import Optimality
from engine.deform.model import BarrierBounds
from engine.maps import Boundary, Certificate, HarmonicMap, LocalBounds

# Expected gain and complementarity, over the energy: a minimum. At the least weight the latter is
# 3e-7. Measured: with an expected gain of 5e-7 poses were up to 2e-4 pixels off.
OPTIMAL = 4e-7
# A search from elsewhere must gain this part of the energy: less is not worth a jump.
WORTH_A_JUMP = 1e-2
# What a search could still gain is an estimate that holds below this part of the energy.
RELIED_ON = 0.03
# Steps after which a search is given up.
MOST_STEPS = 200
# Steps in a row that are hardly taken: the search is caught.
MOST_STALLED = 12
# One that starts turned is given up when after so many steps its energy is more than so many times
# what is known; measured on 80 requests, those that win are below 35, 9, 1.5 and 1 times that.
ENERGY_CUTOFFS = {12: 50.0, 16: 10.0, 20: 2.0, 24: 1.2, 36: 1.0}
# And when it comes so near (of L) to the minimum that is known, with so little more energy.
REJOINED = 0.02
REJOINED_ENERGY = 1.2


class StartingPoint(Enum):
    """Where a search for the minimum starts."""

    HERE = "from the present map"
    REST = "from the shape at rest"
    LEFT = "from the shape at rest, turned by a quarter to the left"
    RIGHT = "from the shape at rest, turned by a quarter to the right"
    WIDENING = "from the shape at rest, within bounds that widen on the way"

    @property
    def rotation(self) -> float:
        """By which angle the shape is turned at the start, beyond what aligns it."""
        return {StartingPoint.LEFT: pi / 2, StartingPoint.RIGHT: -pi / 2}.get(self, 0.0)

    @property
    def is_rotated(self) -> bool:
        """Whether it is turned at all."""
        return self.rotation != 0.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Search:
    """A search for the minimum, on its way.

    Parameters
    ----------
    handles : Handles
    wish : HandleTargets
    way : StartingPoint
    map : HarmonicMap
    certificate : Certificate
    boundary : Boundary
        With the samples that were added.
    limits : LocalBounds
        What the certificates are for.
    within : LocalBounds
        Where the walls of the samples stand in the end, but for those that are beyond.
    reach : float
        Of the rung that the walls stand on (`rungs.rung`).
    walls : BarrierBounds
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
    caught : int
        Steps in a row that were hardly taken.
    optimality : Optimality
    turn : float
        By which angle the shape was turned at the start, beyond what aligns it.
    most : int
        Steps before it is given up.
    best : Search or None
        Of the other ways: a search that leads to no less is given up.
    """

    handles: Handles
    targets: HandleTargets
    starting_point: StartingPoint
    map: HarmonicMap
    certificate: Certificate
    boundary: Boundary
    limits: LocalBounds
    final_limits: LocalBounds
    level_width: float
    bounds: BarrierBounds
    weight: float
    energy: float
    duals: Floats | None = None
    steps: int = 0
    length: float = 1.0
    gain: float = np.inf
    stalled_steps: int = 0
    optimality: Optimality = field(default_factory=Optimality)
    start_rotation: float = 0.0
    max_steps: int = MOST_STEPS
    best: "Search | None" = None

    @property
    def final_bounds(self) -> BarrierBounds:
        """Where the walls stand in the end."""
        return BarrierBounds.at(self.final_limits, self.boundary)

    @property
    def level_bounds(self) -> BarrierBounds:
        """Where they stand now."""
        return homotopy_level(self.final_bounds, self.level_width)

    @property
    def is_widest(self) -> bool:
        """Whether the walls stand where they will in the end."""
        return are_same_bounds(self.level_bounds, self.final_bounds)

    @property
    def has_converged(self) -> bool:
        """Whether the map is a minimum."""
        return self.is_widest and self.optimality.measure <= OPTIMAL

    @property
    def is_over(self) -> bool:
        """Whether the search found a minimum, or is given up."""
        return (
            self.has_converged
            or self.steps >= self.max_steps
            or self.stalled_steps >= MOST_STALLED
            or (self.best is not None and self._cannot_win(self.best))
        )

    def _cannot_win(self, best: "Search") -> bool:
        """Tell whether another search has found less energy than this one can come to."""
        if (
            self.starting_point.is_rotated
            and self.energy > ENERGY_CUTOFFS.get(self.steps, np.inf) * best.energy
        ):
            return True
        low_enough, gap = (1.0 - WORTH_A_JUMP) * best.energy, self.optimality.gap
        if not best.has_converged or not self.is_widest or self.energy < low_enough:
            return False
        if gap < RELIED_ON * self.energy and self.energy - gap > low_enough:
            return True
        near = self.energy < REJOINED_ENERGY * best.energy
        return near and self._distance(best) < REJOINED * self.boundary.size

    def _distance(self, other: "Search") -> float:
        """Return how far the outline is, at most, from where another map has it."""
        coordinates = self.boundary.vertex_coordinates
        phi, psi = (one - its for one, its in zip(self.map.columns, other.map.columns, strict=True))
        return float(np.abs(coordinates @ phi + (coordinates @ psi).conj()).max())
