"""Where a drawing is stiff: limbs around bones, what a brush reaches, and what is carried over.

In: the loops of a domain, and places in it.
Out: shares from 0 to 1 along the loops, and stiffnesses there.
Imports: `engine.geometry`.
"""

from engine.domain.material.brush import brushed as brushed
from engine.domain.material.carrying import carried_stiffness as carried_stiffness
from engine.domain.material.limb import limb_around as limb_around
