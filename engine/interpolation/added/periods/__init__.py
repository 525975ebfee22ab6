"""In-betweens around holes: their periods are closed by the smallest holomorphic correction.

In: the boundary of a domain with holes; in-betweens before their correction.
Out: the correction as few functions times series in time.
Imports: `engine.maps`, `engine.paths`, `engine.interpolation.series`.
"""

from engine.interpolation.added.periods.basis import (
    PeriodBasis as PeriodBasis,
    as_complex as as_complex,
)
from engine.interpolation.added.periods.closing import (
    Closing as Closing,
    Unclosed as Unclosed,
    close as close,
    correction as correction,
    to_conformal as to_conformal,
)
