"""Functions of time as Chebyshev series, alone or multiplied by functions of space.

In: functions of time.
Out: series on pieces of time; a few functions of space, each times a series.
Imports: `engine.arrays`.
"""

from engine.interpolation.series import chebyshev as chebyshev
from engine.interpolation.series.chebyshev import (
    PiecewiseSeries as PiecewiseSeries,
    constant_one as constant_one,
    finish as finish,
    separate_variables as separate_variables,
)
from engine.interpolation.series.residual import (
    HoleConstants as HoleConstants,
    Residual as Residual,
    combine_arrays as combine_arrays,
)
