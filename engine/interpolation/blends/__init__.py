"""The variants of the paper: how the derivatives of an in-between follow from the keyframes'.

In: the passage from one keyframe to the next; for the metric variant an outline's transform.
Out: f_z, conj(f_z̄) and their derivatives at any time.
Imports: `engine.dirichlet`, `engine.interpolation.derivatives`, `engine.interpolation.periods`.
"""

from engine.interpolation.blends.eta import EtaBlend as EtaBlend
from engine.interpolation.blends.metric import (
    MetricResidual as MetricResidual,
    OutlineMetric as OutlineMetric,
)
from engine.interpolation.blends.nu import NuBlend as NuBlend
