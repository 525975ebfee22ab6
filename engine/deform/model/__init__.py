"""The objective of a step: energy, barrier and handles, and its Newton models.

In: a boundary, handles, targets, barrier bounds, and the evaluation of a map.
Out: values, gradients, Hessians, and directions; inner distortion bounds from boundary limits.
Imports: `engine.dirichlet`, `engine.maps`, and the handles of `engine.deform`.
"""

from engine.deform.model.barrier import (
    MARGIN as MARGIN,
    Barrier as Barrier,
    BarrierBounds as BarrierBounds,
    interpolate_duals as interpolate_duals,
)
from engine.deform.model.energy import (
    RadialDerivatives as RadialDerivatives,
    symmetric_dirichlet as symmetric_dirichlet,
    symmetric_dirichlet_derivatives as symmetric_dirichlet_derivatives,
)
from engine.deform.model.evaluation import Evaluation as Evaluation
from engine.deform.model.factors import (
    SHIFT as SHIFT,
    factor_regularised as factor_regularised,
    factor_shifted as factor_shifted,
    solve_factored as solve_factored,
)
from engine.deform.model.hessian import (
    projected_hessian as projected_hessian,
    stiffening_hessian as stiffening_hessian,
)
from engine.deform.model.inner_limits import limits_inside as limits_inside
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
