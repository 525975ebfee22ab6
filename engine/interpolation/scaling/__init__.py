"""The scaling ρ of η: by the pointwise rule of the paper (Section 7.3), and without kinks.

In: keyframes, an outline, time weights, bounds.
Out: the factor ρ at any time.
Imports: `engine.maps`, `engine.interpolation.time_weights.weights`, `engine.interpolation.added`.
"""

from engine.interpolation.scaling.exact_rho import (
    BESIDE_KEY as BESIDE_KEY,
    ExactRho as ExactRho,
    blend_in_outline_bounds as blend_in_outline_bounds,
)
from engine.interpolation.scaling.pointwise import (
    KeyframeExtremes as KeyframeExtremes,
    PointSamples as PointSamples,
)
from engine.interpolation.scaling.smoothed_rho import (
    RhoEnclosures as RhoEnclosures,
    SmoothedRho as SmoothedRho,
)
