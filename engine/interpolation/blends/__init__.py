"""The variants of the paper: how the derivatives of an in-between follow from the keyframes'.

In: the passage from one keyframe to the next; for the metric variant an outline's transform.
Out: f_z, conj(f_z̄) and their derivatives at any time; what is blended, and how far it distorts.
Imports: `engine.dirichlet`, `engine.interpolation.keyframe_blend`,
`engine.interpolation.enclosures`,
`engine.interpolation.scaling`, `engine.interpolation.time_weights`, `engine.interpolation.added`.
"""

from engine.interpolation.blends.blend import Blend as Blend
from engine.interpolation.blends.table import BLENDS as BLENDS
