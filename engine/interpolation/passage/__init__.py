"""Keyframes at the sites, and what all variants have in common on the way from one to the next.

In: harmonic maps, sites, a course.
Out: log f_z of in-betweens, and what each keyframe contributes to them.
Imports: `engine.interpolation.courses`, `engine.interpolation.series`,
`engine.interpolation.sites`.
"""

from engine.interpolation.passage.derivatives import (
    Derivatives as Derivatives,
    Passage as Passage,
    weighted as weighted,
)
from engine.interpolation.passage.interval import (
    BoundaryResidual as BoundaryResidual,
    Interval as Interval,
)
from engine.interpolation.passage.keyframe_samples import (
    KeyframeSamples as KeyframeSamples,
    sample_keyframes as sample_keyframes,
)
