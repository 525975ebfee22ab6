"""The scaling ρ of η: by the pointwise rule of the paper (Section 7.3), and without kinks.

In: keyframes, an outline, the course through the keys, bounds.
Out: the factor ρ at any time.
Imports: `engine.maps`, `engine.interpolation.courses.course`, `engine.interpolation.added`.
"""

from engine.interpolation.scaling.pointwise import (
    PointSamples as PointSamples,
    Worst as Worst,
)
from engine.interpolation.scaling.sharp import (
    BESIDE_KEY as BESIDE_KEY,
    SharpScaling as SharpScaling,
    looseness as looseness,
)
from engine.interpolation.scaling.smooth import (
    Scaling as Scaling,
    ScalingEnclosures as ScalingEnclosures,
)
