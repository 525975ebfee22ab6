"""Where a drawing is stiff: limbs around bones, what a brush reaches, and what is carried over.

In: the loops of a domain, and places in it.
Out: shares from 0 to 1 along the loops, and stiffnesses there.
Imports: `engine.geometry`.
"""

from engine.domain.material.brush import brush_weights as brush_weights
from engine.domain.material.limb import limb_weights as limb_weights
from engine.domain.material.transfer import copy_nearest_stiffness as copy_nearest_stiffness
