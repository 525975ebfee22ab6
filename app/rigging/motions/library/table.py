"""The motion presets by name."""

from app.rigging.motions.library.bipeds import JUMP, NOD, RUN, WALK, WAVE
from app.rigging.motions.library.chains import SLITHER, WAG
from app.rigging.motions.library.four_legs import TROT
from app.rigging.motions.library.whole_body import BREATHE, HOP, SWAY

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
