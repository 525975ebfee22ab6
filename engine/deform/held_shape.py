"""A shape with its handles and bounds, which drags and searches are about."""

from dataclasses import dataclass

from engine.deform.handles import Handles, Wish
from engine.deform.model import Jet, Objective
from engine.deform.state import State
from engine.maps import Boundary, Bounds, Certificate, HarmonicMap


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HeldShape:
    """A shape that is held by handles within bounds.

    Parameters
    ----------
    boundary : Boundary
        Of the shape, as sampled.
    handles : Handles
    bounds : Bounds
    """

    boundary: Boundary
    handles: Handles
    bounds: Bounds

    @property
    def at_rest(self) -> HarmonicMap:
        """The identity."""
        return HarmonicMap.identity(self.boundary.cage, self.boundary.holes)

    def allows(self, certificate: Certificate) -> bool:
        """Tell whether a map with this certificate is within the bounds."""
        return self.bounds.allow(
            k=certificate.k, sigma_a=certificate.sigma_a, sigma_b=certificate.sigma_b
        )

    def measured(self, state: State, wish: Wish) -> tuple[Objective, Jet]:
        """Return the objective without a barrier, over the shape's own samples, and a map's jet."""
        objective = Objective(boundary=self.boundary, handles=self.handles, wish=wish)
        return objective, objective.jet(*state.map.columns)
