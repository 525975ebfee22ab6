"""Motions of chains, such as snakes, fish, tails and scarves, and of tails of animals."""

from app.rigging.motions.curves import EIGHTHS, even_curve
from app.rigging.motions.leg_chains import STANDING, LimbMotion
from app.rigging.motions.motion import Motion
from app.rigging.motions.waves import Wave
from app.texts import _

SLITHER = Motion(
    name="slither",
    label=_("Slither"),
    hint=_("A wave runs from the head to the tail"),
    seconds=1.5,
    phases=EIGHTHS,
    templates={"chain": Wave(degrees=32, waves=1.0, first=0.6)},
)

WAG = Motion(
    name="wag",
    label=_("Wag"),
    hint=_("The tail swings, its tip last; a chain is held at its first joint"),
    seconds=1.0,
    phases=EIGHTHS,
    templates={
        "chain": Wave(degrees=34, waves=0.35, first=0.15, held=True),
        # Twice in a cycle; the head answers the tail a little.
        "four-legs": LimbMotion(
            turns={
                "tail": even_curve(4, 13, -4, -13, 4, 13, -4, -13),
                "head": even_curve(1, 0, -1, 0, 1, 2, 1, 2),
            },
            gait=STANDING,
            needed=("hips", "tail"),
        ),
    },
)
