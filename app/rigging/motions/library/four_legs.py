"""Motions of four-legged bodies."""

from app.rigging.motions.curves import EIGHTHS, even_curve
from app.rigging.motions.leg_chains import LimbMotion
from app.rigging.motions.motion import Motion
from app.rigging.motions.steps import Gait
from app.texts import _

FEET = ("hips", "chest")
_TRUNK = {
    "neck": even_curve(2, -2, 2, -2),
    "head": even_curve(-3, 3, -3, 3),
    "tail": even_curve(0, 8, 0, -8),
}

# Four beats: a hind foot, then the front foot of its side.
WALK_ON_FOUR = LimbMotion(
    gait=Gait(
        stance=0.625,
        stride=0.8,
        lift=0.1,
        landings=(("foot.L", 0.0), ("hand.L", 0.25), ("foot.R", 0.5), ("hand.R", 0.75)),
        gathered=0.25,
        roll=20,
        straight=0.995,
    ),
    rise=even_curve(0.0, -0.01, 0.0, 0.01, 0.0, -0.01, 0.0, 0.01),
    turns={**_TRUNK, "chest": even_curve(0, 1, 0, -1)},
    needed=FEET,
)

# Two beats: diagonal feet move together.
TROT = Motion(
    name="trot",
    label=_("Trot"),
    hint=_("Diagonal feet step together, with a bounce between the steps"),
    seconds=0.75,
    phases=EIGHTHS,
    templates={
        "four-legs": LimbMotion(
            gait=Gait(
                stance=0.375,
                stride=1.3,
                lift=0.14,
                landings=(("foot.L", 0.0), ("hand.R", 0.0), ("foot.R", 0.5), ("hand.L", 0.5)),
                gathered=0.7,
                roll=28,
            ),
            rise=even_curve(0.0, -0.035, 0.0, 0.035, 0.0, -0.035, 0.0, 0.035),
            turns={
                "neck": even_curve(2, 0, -2, 0, 2, 0, -2, 0),
                "head": even_curve(-2, 2, 2, -2, -2, 2, 2, -2),
                "tail": even_curve(4, 10, 4, -2, 4, 10, 4, -2),
                "chest": even_curve(0, 1, 0, -1, 0, 1, 0, -1),
            },
            needed=FEET,
        )
    },
)

# Hind feet, then front feet, then all in the air, gathered below the body.
GALLOP = Motion(
    name="gallop",
    label=_("Gallop"),
    hint=_("Hind feet, then front feet, then a moment in the air"),
    seconds=2 / 3,
    phases=EIGHTHS,
    templates={
        "four-legs": LimbMotion(
            gait=Gait(
                stance=0.25,
                stride=1.8,
                lift=0.18,
                landings=(("foot.L", 0.0), ("foot.R", 0.125), ("hand.L", 0.375), ("hand.R", 0.5)),
                gathered=0.3,
                roll=30,
            ),
            rise=even_curve(-0.02, -0.03, 0.0, 0.02, 0.0, -0.01, 0.04, 0.03),
            turns={
                "neck": even_curve(3, 1, -2, -5, -4, -1, 2, 4),
                "head": even_curve(-2, 0, 2, 4, 3, 0, -2, -3),
                "tail": even_curve(4, 8, 10, 6, 0, -6, -4, 0),
                "chest": even_curve(3, 2, 0, -3, -3, -1, 1, 3),
            },
            needed=FEET,
        )
    },
)
