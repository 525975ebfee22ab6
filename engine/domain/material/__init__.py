"""Stiffness of a drawing: limbs around bones, brush strokes, and transfer to a new outline.

In: the loops of a domain, and places in it.
Out: shares from 0 to 1 along the loops, and stiffnesses there.
Imports: `engine.geometry`.
"""

from engine.domain.material.brush import brush_weights as brush_weights
from engine.domain.material.limb import limb_weights as limb_weights
from engine.domain.material.transfer import copy_nearest_stiffness as copy_nearest_stiffness
