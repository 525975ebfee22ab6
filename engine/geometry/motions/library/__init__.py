"""Ready motions, as data: angles of bones in degrees, and steps in lengths of a leg.

In: nothing.
Out: motions by name, made by us from what every textbook of animation teaches; in the public
domain (CC0).
Imports: the forms of motions beside it.
"""

from engine.geometry.motions.library.bipeds import JUMP, NOD, RUN, WALK, WAVE
from engine.geometry.motions.library.chains import SLITHER, WAG
from engine.geometry.motions.library.four_legs import TROT
from engine.geometry.motions.library.whole_body import BREATHE, HOP, SWAY

MOTIONS = {
    "walk": WALK,
    "run": RUN,
    "wave": WAVE,
    "nod": NOD,
    "jump": JUMP,
    "trot": TROT,
    "slither": SLITHER,
    "wag": WAG,
    "breathe": BREATHE,
    "sway": SWAY,
    "hop": HOP,
}
