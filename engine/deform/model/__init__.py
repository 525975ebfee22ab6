"""What a step minimises: energy, barrier and handles, and Newton's models of them.

In: a boundary, handles, a wish, walls, and the measures of a map.
Out: values, gradients, Hessians, and directions; what limits on the boundary promise inside.
Imports: `engine.dirichlet`, `engine.maps`, and the handles of `engine.deform`.
"""

from engine.deform.model.barrier import (
    MARGIN as MARGIN,
    Barrier as Barrier,
    Walls as Walls,
    with_samples_between as with_samples_between,
)
from engine.deform.model.energy import (
    Radial as Radial,
    symmetric_dirichlet as symmetric_dirichlet,
    symmetric_dirichlet_derivatives as symmetric_dirichlet_derivatives,
)
from engine.deform.model.factors import (
    SHIFT as SHIFT,
    factor_of as factor_of,
    factor_shifted as factor_shifted,
    solved as solved,
)
from engine.deform.model.hessian import (
    projected_hessian as projected_hessian,
    stiffening as stiffening,
)
from engine.deform.model.inner_limits import limits_inside as limits_inside
from engine.deform.model.jet import Jet as Jet
from engine.deform.model.newton import (
    SHORTEST as SHORTEST,
    SUFFICIENT as SUFFICIENT,
    Direction as Direction,
    Model as Model,
    Preconditioner as Preconditioner,
    line_search as line_search,
    newton_direction as newton_direction,
    newton_models as newton_models,
    preconditioned_direction as preconditioned_direction,
)
from engine.deform.model.objective import Objective as Objective
from engine.deform.model.unknowns import by_unknowns as by_unknowns, in_basis as in_basis
