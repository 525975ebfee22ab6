"""A shape with handles and bounds, shared by drags and searches."""

from dataclasses import dataclass

from engine.deform.handles import Handles, HandleTargets
from engine.deform.model.evaluation import Evaluation
from engine.deform.model.objective import Objective
from engine.deform.state import State
from engine.maps import Boundary, HarmonicMap, LocalBounds


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ConstrainedShape:
    """A shape that is held by handles within bounds.

    `boundary` is the shape as sampled. Limits may differ from sample to sample.
    """

    boundary: Boundary
    handles: Handles
    bounds: LocalBounds

    @property
    def rest_map(self) -> HarmonicMap:
        """The identity."""
        return HarmonicMap.identity(self.boundary.cage, self.boundary.holes)

    def allows(self, state: State) -> bool:
        proven = state.certificate
        return self.bounds.include(state.limits) or self.bounds.allow(
            k=proven.k, sigma_a=proven.sigma_a, sigma_b=proven.sigma_b
        )

    def measure_state(self, state: State, targets: HandleTargets) -> tuple[Objective, Evaluation]:
        """Return the objective without a barrier, over the shape's samples, and the evaluation."""
        objective = Objective(boundary=self.boundary, handles=self.handles, targets=targets)
        return objective, objective.evaluate(*state.map.columns)
