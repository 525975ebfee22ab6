"""Functions of time as Chebyshev series, alone or times functions of the place.

In: functions of time.
Out: series on pieces of time; few functions of the place, each times a series.
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
