"""State of one search for the minimum, and its stopping rules."""

from dataclasses import dataclass, field
from enum import Enum
from math import pi

import numpy as np

from engine.arrays import Floats
from engine.deform.handles import Handles, HandleTargets
from engine.deform.interior_point.homotopy import are_same_bounds, homotopy_level
from engine.deform.interior_point.optimality import Optimality
from engine.deform.model.barrier import BarrierBounds
from engine.maps import Boundary, Certificate, HarmonicMap, LocalBounds

# Optimality measure of a minimum. At the least weight the complementarity is 3e-7. Measured: with
# an expected gain of 5e-7 poses were up to 2e-4 pixels off.
OPTIMAL = 4e-7
# A search from elsewhere must gain this part of the energy: less does not justify a jump.
WORTH_A_JUMP = 1e-2
# The estimate of the remaining gain holds below this part of the energy.
RELIED_ON = 0.03
# Steps after which a search is given up.
MOST_STEPS = 200
# Stalled steps in a row, after which the search is given up.
MOST_STALLED = 12
# A search from a rotated start is given up when after so many steps its energy exceeds so many
# times the best known. Measured on 80 requests: those that win are below 35, 9, 1.5 and 1 times the
# best.
ENERGY_CUTOFFS = {12: 50.0, 16: 10.0, 20: 2.0, 24: 1.2, 36: 1.0}
# It also ends when it comes this near (of L) to the best known minimum, with so little more energy.
REJOINED = 0.02
REJOINED_ENERGY = 1.2


class StartingPoint(Enum):
    """Starting point of a search for the minimum."""

    HERE = "from the present map"
    REST = "from the shape at rest"
    LEFT = "from the shape at rest, turned by a quarter to the left"
    RIGHT = "from the shape at rest, turned by a quarter to the right"
    WIDENING = "from the shape at rest, within bounds that widen on the way"

    @property
    def rotation(self) -> float:
        """Rotation of the shape at the start, beyond the aligning one, in radians."""
        return {StartingPoint.LEFT: pi / 2, StartingPoint.RIGHT: -pi / 2}.get(self, 0.0)

    @property
    def is_rotated(self) -> bool:
        return self.rotation != 0.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Search:
    """A search for the minimum in progress.

    Parameters
    ----------
    boundary : Boundary
        With the samples that were added.
    limits : LocalBounds
        Of the certificates.
    final_limits : LocalBounds
        Final barrier bounds of the samples, except samples beyond them.
    level_width : float
        Of the present level (`homotopy.homotopy_level`).
    bounds : BarrierBounds
        The present ones.
    weight : float
        Of the barrier.
    duals : float64, shape (3, m), or None
    energy : float
        Of the map with its handles, at the full targets.
    length : float
        Part of the last step that was taken.
    gain : float
        Expected gain of the last step.
    stalled_steps : int
        Steps in a row that were hardly taken.
    start_rotation : float
        Rotation of the shape at the start, beyond the aligning one, in radians.
    max_steps : int
        Steps after which the search is given up.
    best : Search or None
        Best of the other searches: a search that cannot beat it is given up.
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
        """Barrier bounds at the end of the search."""
        return BarrierBounds.at(self.final_limits, self.boundary)

    @property
    def level_bounds(self) -> BarrierBounds:
        """Barrier bounds of the present level."""
        return homotopy_level(self.final_bounds, self.level_width)

    @property
    def is_widest(self) -> bool:
        """Whether the barrier bounds are the final ones."""
        return are_same_bounds(self.level_bounds, self.final_bounds)

    @property
    def has_converged(self) -> bool:
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
        """Whether another search has less energy than this search can reach."""
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
        """Return the largest distance of the outline from its place under another map."""
        coordinates = self.boundary.vertex_coordinates
        phi, psi = (one - its for one, its in zip(self.map.columns, other.map.columns, strict=True))
        return float(np.abs(coordinates @ phi + (coordinates @ psi).conj()).max())
