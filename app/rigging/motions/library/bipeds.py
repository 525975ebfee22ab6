"""Motions of bipeds, and the walk of all kinds."""

from app.rigging.motions.curves import EIGHTHS, Curve, even_curve
from app.rigging.motions.leg_chains import STANDING, LimbMotion
from app.rigging.motions.library.four_legs import WALK_ON_FOUR
from app.rigging.motions.motion import Motion
from app.rigging.motions.steps import Gait
from app.texts import _

LEFT_RIGHT = (("foot.L", 0.0), ("foot.R", 0.5))
FEET = ("hips", "foot.L", "foot.R")
LEAPERS = ("hips",)  # from the side both legs may be one joint chain

# Contact, down, passing, up, for each foot: the body is lowest after a foot came down, and highest
# as the other foot passes it. Arms swing against legs.
WALK = Motion(
    name="walk",
    label=_("Walk"),
    hint=_("One foot after the other, arms against legs"),
    seconds=1.0,
    phases=EIGHTHS,
    templates={
        "biped-side": LimbMotion(
            gait=Gait(
                stance=0.5, stride=1.2, lift=0.12, landings=LEFT_RIGHT, roll=30, gathered=0.7
            ),
            rise=even_curve(0.0, -0.02, 0.0, 0.02, 0.0, -0.02, 0.0, 0.02),
            turns={
                "chest": even_curve(-3, -4, -3, -2, -3, -4, -3, -2),
                "head": even_curve(3, 5, 3, 1, 3, 5, 3, 1),
                "elbow": even_curve(-17, 0, 17, 0),
                "hand": even_curve(2, 5, 14, 8),
                "tail": even_curve(0, 6, 0, -6),
            },
            needed=FEET,
        ),
        "biped-front": LimbMotion(
            gait=Gait(
                stance=0.5,
                stride=0.3,
                lift=0.1,
                landings=LEFT_RIGHT,
                gathered=0.0,
                is_treadmill=False,
                straight=0.997,
            ),
            rise=even_curve(0.0, -0.02, 0.0, 0.025, 0.0, -0.02, 0.0, 0.025),
            shift=even_curve(0.0, 0.06, 0.06, 0.0, -0.06, -0.06),
            turns={
                "hips": even_curve(0, -3, -3, 0, 3, 3),
                "chest": even_curve(0, -1, -1, 0, 1, 1),
                "head": even_curve(0, 3, 3, 0, -3, -3),
                "elbow": even_curve(-6, 2, 10, 2),
                "hand": even_curve(0, 4, 12, 6),
                "tail": even_curve(0, 6, 0, -6),
            },
            needed=FEET,
        ),
        "four-legs": WALK_ON_FOUR,
    },
)

# Both feet leave the ground between steps.
RUN = Motion(
    name="run",
    label=_("Run"),
    hint=_("Long steps, and a moment in the air between them"),
    seconds=2 / 3,
    phases=EIGHTHS,
    templates={
        "biped-side": LimbMotion(
            gait=Gait(
                stance=0.375, stride=1.9, lift=0.18, landings=LEFT_RIGHT, gathered=1.0, roll=45
            ),
            rise=Curve(
                ((0.0, 0.0), (0.17, -0.05), (0.42, 0.05), (0.5, 0.0), (0.67, -0.05), (0.92, 0.05))
            ),
            turns={
                "chest": even_curve(-9, -11, -9, -8, -9, -11, -9, -8),
                "head": even_curve(7, 9, 7, 6, 7, 9, 7, 6),
                "elbow": even_curve(-21, 0, 21, 0),
                "hand": even_curve(10, 13, 20, 15),
                "tail": even_curve(0, 9, 0, -9),
            },
            needed=FEET,
        ),
        "biped-front": LimbMotion(
            gait=Gait(
                stance=0.375,
                stride=0.5,
                lift=0.2,
                landings=LEFT_RIGHT,
                gathered=0.0,
                is_treadmill=False,
                straight=0.997,
            ),
            rise=Curve(
                ((0.0, 0.0), (0.17, -0.05), (0.42, 0.05), (0.5, 0.0), (0.67, -0.05), (0.92, 0.05))
            ),
            shift=even_curve(0.0, 0.04, 0.04, 0.0, -0.04, -0.04),
            turns={
                "hips": even_curve(0, -3, -3, 0, 3, 3),
                "chest": even_curve(0, -1, -1, 0, 1, 1),
                "head": even_curve(0, 3, 3, 0, -3, -3),
                "elbow": even_curve(-4, 8, 22, 8),
                "hand": even_curve(6, 14, 28, 16),
                "tail": even_curve(0, 9, 0, -9),
            },
            needed=FEET,
        ),
    },
)

_RAISED = even_curve(0, 20, 38, 41, 38, 41, 38, 41, 38, 28, 8, 0)
_SHAKEN = even_curve(0, 18, 60, 30, 60, 30, 60, 30, 60, 30, 8, 0)
_GREETING = {
    "chest": even_curve(0, 1, 2, 3, 2, 3, 2, 3, 2, 1, 0, 0),
    "head": even_curve(0, 2, 4, 2, 4, 2, 4, 2, 4, 2, 0, 0),
}
WAVE = Motion(
    name="wave",
    label=_("Wave"),
    hint=_("An arm goes up, waves and comes down"),
    seconds=2.0,
    phases=EIGHTHS,
    templates={
        kind: LimbMotion(
            turns=_GREETING,
            single={"elbow.R": _RAISED, "hand.R": _SHAKEN},
            needed=("hips",),
            either=("hand.R", "hand.L"),
        )
        for kind in ("biped-front", "biped-side")
    },
)

NOD = Motion(
    name="nod",
    label=_("Nod"),
    hint=_("The head says yes, twice"),
    seconds=1.5,
    phases=EIGHTHS,
    templates={
        "biped-side": LimbMotion(
            turns={
                "chest": even_curve(0, -2, -1, -2, -1, 0),
                "neck": even_curve(0, -5, 1, -4, 1, 0),
                "head": even_curve(0, -5, -14, -4, 3, -4, -12, -4, 2, 1, 0, 0),
            },
            needed=("hips", "head"),
        ),
        # From the front a nodding head comes down and up again.
        "biped-front": LimbMotion(
            turns={"head": even_curve(0, 1, 2, 1, 0, -1, -2, -1)},
            rise=even_curve(0, -0.02, -0.06, -0.02, 0.01, -0.02, -0.05, -0.02, 0.005, 0, 0, 0),
            gait=STANDING,
            needed=("hips", "head"),
        ),
    },
)

# Crouch, take off, fly, land, and come up.
_LEAP = LimbMotion(
    gait=Gait(
        stance=0.62,
        stride=0.0,
        lift=0.26,
        landings=(("foot.L", 0.72), ("foot.R", 0.72)),
        gathered=0.0,
        roll=16,
    ),
    lag=0.0,
    rise=Curve(
        (
            (0.0, 0.0),
            (0.2, -0.15),
            (0.34, 0.0),
            (0.53, 0.34),
            (0.72, 0.0),
            (0.82, -0.12),
            (0.94, -0.03),
        )
    ),
    leans={
        "chest": Curve(
            ((0.0, 0), (0.2, -8), (0.36, 1), (0.55, 0), (0.72, -2), (0.82, -7), (0.94, -1))
        ),
        "head": Curve(((0.0, 0), (0.2, 6), (0.36, 3), (0.55, -3), (0.72, 2), (0.82, 5), (0.94, 1))),
        "tail": Curve(
            ((0.0, 0), (0.2, 8), (0.38, -10), (0.55, -5), (0.72, 8), (0.82, 10), (0.94, 2))
        ),
    },
    turns={
        "elbow": Curve(
            ((0.0, 0), (0.2, -16), (0.38, 14), (0.55, 24), (0.72, 12), (0.82, -4), (0.94, -2))
        ),
        "hand": Curve(
            ((0.0, 0), (0.2, 4), (0.38, 10), (0.55, 14), (0.72, 9), (0.82, 6), (0.94, 1))
        ),
    },
    needed=LEAPERS,
)


JUMP = Motion(
    name="jump",
    label=_("Jump"),
    hint=_("Crouch, leap, land and rise again"),
    seconds=1.25,
    phases=EIGHTHS,
    templates={"biped-side": _LEAP, "biped-front": _LEAP},
)

# Like a kangaroo: both feet land together, the body sinks and is thrown ahead, the tail against it.
LEAPING = LimbMotion(
    gait=Gait(
        stance=0.42,
        stride=0.75,
        lift=0.22,
        landings=(("foot.L", 0.0), ("foot.R", 0.0)),
        gathered=0.0,
        roll=20,
    ),
    lag=0.0,
    rise=Curve(((0.0, 0.0), (0.2, -0.16), (0.42, 0.02), (0.7, 0.22), (0.9, 0.06))),
    leans={
        "chest": Curve(((0.0, 1), (0.2, -7), (0.42, -3), (0.7, 2), (0.9, 3))),
        "head": Curve(((0.0, 2), (0.2, 6), (0.42, 3), (0.7, -2), (0.9, -2))),
        "tail": Curve(((0.0, 6), (0.2, -10), (0.42, -4), (0.7, 12), (0.9, 12))),
    },
    turns={
        "elbow": Curve(((0.0, -4), (0.2, -10), (0.42, 6), (0.7, 14), (0.9, 4))),
        "hand": Curve(((0.0, 2), (0.2, 6), (0.42, 8), (0.7, 12), (0.9, 6))),
    },
    needed=LEAPERS,
)
