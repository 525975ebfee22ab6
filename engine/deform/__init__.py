"""The deformer: handles, energy, barrier and Newton steps (Chen and Weber 2015, 2017).

In: a certified map, handles and their targets.
Out: certified maps whose handles are nearer to their targets, with status and statistics.
Imports: `engine.dirichlet`, `engine.maps`, `engine.geometry`.
"""

from engine.deform.deformer import Deformer as Deformer
from engine.deform.forces.armature import Armature as Armature
from engine.deform.forces.bones import Aim as Aim, Hinge as Hinge, Shaft as Shaft
from engine.deform.forces.posed_armature import AIM_STIFFNESS as AIM_STIFFNESS
from engine.deform.forces.pulls import (
    MAX_PULL_FORCE as MAX_PULL_FORCE,
    BoundedPull as BoundedPull,
)
from engine.deform.forces.ties import Ties as Ties
from engine.deform.handles import (
    MOST_HANDLES as MOST_HANDLES,
    Handles as Handles,
    HandleTargets as HandleTargets,
    require_held as require_held,
)
from engine.deform.interior_point.optimality import ActiveBound as ActiveBound
from engine.deform.interior_point.search import StartingPoint as StartingPoint
from engine.deform.model.hessian import projected_hessian as projected_hessian
from engine.deform.model.inner_limits import limits_inside as limits_inside
from engine.deform.model.newton import (
    line_search as line_search,
    newton_direction as newton_direction,
)
from engine.deform.model.objective import Objective as Objective
from engine.deform.state import State as State, Statistics as Statistics, Status as Status
