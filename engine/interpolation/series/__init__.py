"""Functions of time as Chebyshev series, alone or times functions of the place.

In: functions of time.
Out: series on pieces of time; few functions of the place, each times a series.
Imports: `engine.arrays`.
"""

from engine.interpolation.series import chebyshev as chebyshev
from engine.interpolation.series.chebyshev import (
    PiecewiseSeries as PiecewiseSeries,
    finish as finish,
    one as one,
    separate as separate,
)
from engine.interpolation.series.residual import (
    HoleConstants as HoleConstants,
    Residual as Residual,
    combined as combined,
)
