"""The motion presets by name."""

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
