"""Corrections of in-betweens, in the variables in which they are blended.

In: f_z and conj(f_z̄) of a frame at the nodes of paths to some points, and targets of the points.
Out: two holomorphic functions h and q that bring the points to their targets; the corrected frame's
distortion follows from moduli.
Imports: `engine.maps`, `engine.paths`.
"""

from engine.deform.correction.barrier import (
    WIDTH as WIDTH,
    LimitBarrier as LimitBarrier,
    extremes as extremes,
    log_distortions as log_distortions,
)
from engine.deform.correction.corrector import (
    PointCorrector as PointCorrector,
    build_corrector as build_corrector,
)
from engine.deform.correction.frame import (
    BaseFrame as BaseFrame,
    CorrectedFrame as CorrectedFrame,
)
from engine.deform.correction.limits import (
    BEYOND as BEYOND,
    INSIDE as INSIDE,
    frame_limits as frame_limits,
    log_limits as log_limits,
    max_feasible_share as max_feasible_share,
    shorten_solution as shorten_solution,
    solve_within as solve_within,
)
from engine.deform.correction.paths import PointPaths as PointPaths
from engine.deform.correction.solver import (
    PointSolution as PointSolution,
    PointTargets as PointTargets,
    solve_correction as solve_correction,
)
from engine.deform.correction.variables import (
    Variables as Variables,
    orthonormal_functions as orthonormal_functions,
)
