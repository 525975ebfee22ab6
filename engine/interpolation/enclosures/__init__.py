"""Enclosures of the blended quantities along pieces of the boundary and pieces of time.

In: keyframes and a boundary.
Out: `EndpointValues` and `BoundaryBezier`, the keyframes along pieces; `BernsteinPatch` and
`BilinearPatch`, quantities on cells; enclosures of k, σ_a and σ_b on cells.
Imports: `engine.maps`.
"""

from engine.interpolation.enclosures.cells import (
    BernsteinPatch as BernsteinPatch,
    BlendChanges as BlendChanges,
    enclose_changed_metric as enclose_changed_metric,
    enclose_exponential as enclose_exponential,
    enclose_linear as enclose_linear,
    enclose_metric as enclose_metric,
    project_on_mean as project_on_mean,
)
from engine.interpolation.enclosures.pieces import (
    BoundaryBezier as BoundaryBezier,
    EndpointValues as EndpointValues,
    Subdivision as Subdivision,
    append_alternately as append_alternately,
)
from engine.interpolation.enclosures.sheets import (
    BilinearPatch as BilinearPatch,
    log_modulus_of_metric as log_modulus_of_metric,
)
