"""The motion presets by name."""

from app.rigging.motions.library.bipeds import JUMP, NOD, RUN, WALK, WAVE
from app.rigging.motions.library.chains import SLITHER, WAG
from app.rigging.motions.library.four_legs import GALLOP, TROT
from app.rigging.motions.library.gestures import BREATHE, FLY, LOOK, TALK
from app.rigging.motions.library.whole_body import HOP, SWAY
from app.rigging.motions.motion import Motion
from engine.errors import EngineError

MOTIONS = {
    "walk": WALK,
    "run": RUN,
    "wave": WAVE,
    "nod": NOD,
    "jump": JUMP,
    "trot": TROT,
    "gallop": GALLOP,
    "talk": TALK,
    "look": LOOK,
    "fly": FLY,
    "slither": SLITHER,
    "wag": WAG,
    "breathe": BREATHE,
    "sway": SWAY,
    "hop": HOP,
}


def find_motion(name: str) -> Motion:
    """Return the motion with this name; raise an `EngineError` if there is none."""
    if name not in MOTIONS:
        raise EngineError(
            "There is no motion preset {name!r}; choose one of {motions}.",
            name=name,
            motions=", ".join(MOTIONS),
        )
    return MOTIONS[name]
