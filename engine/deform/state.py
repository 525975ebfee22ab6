"""State of a deformation, its status, and statistics of the last step."""

from dataclasses import dataclass, field
from enum import Enum

from engine.arrays import Floats
from engine.deform.handles import Handles, HandleTargets
from engine.deform.interior_point.optimality import ActiveBound
from engine.deform.interior_point.search import Search, StartingPoint
from engine.deform.model.evaluation import Evaluation
from engine.deform.model.newton import Preconditioner
from engine.deform.trust_region import BarrierSchedule
from engine.maps import Boundary, Certificate, HarmonicMap, LocalBounds


class Status(Enum):
    """Progress of a deformation."""

    MOVING = "moving"
    """On its way: more steps lead on."""
    CONVERGED = "converged"
    """At rest in a minimum of the energy, which no bound holds back."""
    FREE = "free"
    """Nothing is asked for: the shape has no handle, and stays as it is within the bounds."""
    AT_LIMITS = "at the limits"
    """At rest in a minimum of the energy within the bounds: they allow no less."""
    UNFINISHED = "unfinished"
    """No more steps lead on, but what was found is not proven to be a minimum."""
    TIGHTENING = "tightening"
    """The bounds became tighter than the map; it is on its way into them."""
    OUTSIDE = "outside the bounds"
    """The map is outside its bounds and finds no way into them."""

    @property
    def is_final(self) -> bool:
        """Whether more steps with the same targets change nothing."""
        return self not in (Status.MOVING, Status.TIGHTENING)

    @property
    def is_solved(self) -> bool:
        """Whether the map is at rest within the bounds."""
        return self in (Status.CONVERGED, Status.AT_LIMITS, Status.FREE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Statistics:
    """Statistics of the last step.

    Parameters
    ----------
    energy : float
        Arc-length mean of the symmetric Dirichlet density; 2 at rest.
    objective : float
        Energy of the shape and of the handles, at their full targets: the minimised function.
    target_error : float
        Root mean square distance of the handles from their targets, over L.
    decrement : float
        Gain that Newton's model expected of the whole step.
    length : float
        Part of the step that was taken.
    has_hit_radius : bool
        Whether the trust region held handles back.
    optimality : float
        Expected gain and complementarity of the bounds over the objective: 0 at a minimum, infinite
        where it is unknown.
    active : tuple of ActiveBound
        Bounds that hold the shape back.
    """

    energy: float
    objective: float
    target_error: float
    decrement: float
    length: float
    has_hit_radius: bool
    optimality: float
    active: tuple[ActiveBound, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class State:
    """A certified map in a deformation, with the data that the next step needs.

    It does not depend on the handles: a deformer with other handles or other bounds can continue
    it.

    Parameters
    ----------
    certificate : Certificate
        Of the map, for its limits.
    limits : LocalBounds
        The bounds, or looser limits on the way into tightened bounds.
    statistics : Statistics or None
        None before the first step.
    boundary : Boundary
        With the samples that were added.
    duals : float64, shape (3, m), or None
        Of the barrier.
    targets, handles
        Of the last step, or None.
    preconditioner : Preconditioner or None
        For the next step.
    evaluation : Evaluation or None
        Of the map, as the last step measured it for its boundary and handles.
    search : Search or None
        For the minimum, once drag steps bring the handles no nearer.
    starting_points : tuple of StartingPoint
        Of this search and of the searches that remain.
    outcome : Search or None
        The best of the finished searches.
    steps : int
        Newton steps of the search that found the map; 0 during a drag.
    search_steps : int
        Newton steps of the finished searches.
    """

    map: HarmonicMap
    certificate: Certificate
    limits: LocalBounds
    status: Status = Status.MOVING
    statistics: Statistics | None = None
    boundary: Boundary
    schedule: BarrierSchedule = field(default_factory=BarrierSchedule)
    duals: Floats | None = None
    targets: HandleTargets | None = None
    handles: Handles | None = None
    preconditioner: Preconditioner | None = None
    evaluation: Evaluation | None = None
    search: Search | None = None
    starting_points: tuple[StartingPoint, ...] = ()
    outcome: Search | None = None
    steps: int = 0
    search_steps: int = 0
