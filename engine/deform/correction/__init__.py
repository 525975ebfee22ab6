"""Corrections of in-betweens in the variables in which they are blended.

In: f_z and conj(f_z̄) of a frame at the nodes of paths to some points, and where those are wanted.
Out: two holomorphic functions h and q; with them the frame's points are where they are wanted, and
its distortion is known from moduli.
Imports: `engine.maps`, `engine.paths`.
"""

from engine.deform.correction.corrector import (
    PointCorrector as PointCorrector,
    corrector_of as corrector_of,
)
from engine.deform.correction.frame import (
    BaseFrame as BaseFrame,
    CorrectedFrame as CorrectedFrame,
)
from engine.deform.correction.limits import (
    BEYOND as BEYOND,
    INSIDE as INSIDE,
    largest_share as largest_share,
    limits_of as limits_of,
    logarithms as logarithms,
    shorten_solution as shorten_solution,
    solve_within as solve_within,
)
from engine.deform.correction.paths import PointPaths as PointPaths
from engine.deform.correction.solver import (
    PointSolution as PointSolution,
    Targets as Targets,
    solve as solve,
)
from engine.deform.correction.variables import Variables as Variables
from engine.deform.correction.walls import (
    WIDTH as WIDTH,
    LimitWalls as LimitWalls,
    extremes as extremes,
    quantities as quantities,
)
