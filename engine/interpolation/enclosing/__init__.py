"""What variants blend, enclosed: along pieces of the boundary, during pieces of time.

In: keyframes and a boundary.
Out: `EndValues` and `EdgeCurves`, what is known of keyframes along pieces; `Patch` and `Sheet`,
quantities on cells; enclosures of k, σ_a and σ_b of such ones.
Imports: `engine.maps`.
"""

from engine.interpolation.enclosing.cells import (
    Changes as Changes,
    Patch as Patch,
    along_mean as along_mean,
    changed_metric as changed_metric,
    exponential as exponential,
    from_metric as from_metric,
    linear as linear,
)
from engine.interpolation.enclosing.pieces import (
    EdgeCurves as EdgeCurves,
    EndValues as EndValues,
    Subdivision as Subdivision,
    followed as followed,
)
from engine.interpolation.enclosing.sheets import (
    Sheet as Sheet,
    log_modulus_of_metric as log_modulus_of_metric,
)
