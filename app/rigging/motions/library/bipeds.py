"""Motions of bipeds, and the walk of all kinds."""

from dataclasses import replace

from app.rigging.motions.curves import EIGHTHS, ArmDirection, Curve, even_curve
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
    hint=_("One foot after the other, on two legs or four"),
    seconds=1.0,
    phases=EIGHTHS,
    templates={
        "biped-side": LimbMotion(
            gait=Gait(
                stance=0.5,
                stride=1.2,
                lift=0.12,
                landings=LEFT_RIGHT,
                roll=30,
                gathered=0.7,
                straight=0.995,
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
                lift=0.04,
                landings=LEFT_RIGHT,
                gathered=0.0,
                is_treadmill=False,
                straight=0.997,
            ),
            rise=even_curve(0.0, -0.006, 0.0, 0.012, 0.0, -0.006, 0.0, 0.012),
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
                stance=0.25,
                stride=2.4,
                landings=LEFT_RIGHT,
                gathered=1.0,
                roll=50,
                fold=0.4,
                behind=0.2,
                crest=0.38,
                follow=0.5,
                straight=0.995,
            ),
            rise=even_curve(0.0, -0.07, 0.02, 0.08, 0.0, -0.07, 0.02, 0.08),
            turns={
                "chest": even_curve(-8, -9, -8, -7, -8, -9, -8, -7),
                "head": even_curve(7, 9, 7, 6, 7, 9, 7, 6),
                "elbow": even_curve(-30, 0, 30, 0),
                "hand": even_curve(50, 55, 65, 55),
                "tail": even_curve(0, 9, 0, -9),
            },
            needed=FEET,
        ),
        "biped-front": LimbMotion(
            gait=Gait(
                stance=0.25,
                stride=0.7,
                landings=LEFT_RIGHT,
                gathered=0.0,
                is_treadmill=False,
                straight=0.997,
                fold=0.07,
            ),
            rise=even_curve(0.0, -0.02, 0.0, 0.08, 0.0, -0.02, 0.0, 0.08),
            shift=even_curve(0.0, 0.04, 0.04, 0.0, -0.04, -0.04),
            turns={
                "hips": even_curve(0, -3, -3, 0, 3, 3),
                "chest": even_curve(0, -1, -1, 0, 1, 1),
                "head": even_curve(0, 3, 3, 0, -3, -3),
                "elbow": even_curve(-10, -1, 8, -1),
                "hand": even_curve(5, 15, 30, 15),
                "tail": even_curve(0, 9, 0, -9),
            },
            needed=FEET,
        ),
    },
)

# The upper arm leads up and down, and the forearm follows; then it swings from the elbow.
_UPPER = ArmDirection(
    angle=95,
    share=even_curve(0, 0.6, 1, 1, 1, 1, 1, 0.45),
    swing=even_curve(0, 0, 2, -3, 2, -3, 2, 0),
)
_FOREARM = ArmDirection(
    angle=170,
    share=even_curve(0, 0.4, 1, 1, 1, 1, 1, 0.55),
    swing=even_curve(0, 0, -26, 16, -26, 16, -26, 0),
)
WAVE = Motion(
    name="wave",
    label=_("Wave"),
    hint=_("An arm goes up, waves and comes down"),
    seconds=2.0,
    phases=EIGHTHS,
    templates={
        kind: LimbMotion(
            turns={"head": even_curve(0, 1, 3, 4, 4, 4, 3, 1)},
            aims={"elbow.R": _UPPER, "hand.R": _FOREARM},
            gait=STANDING,
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
                "chest": even_curve(0, -1, -2, -1, -2, -1, 0, 0),
                "neck": even_curve(1, -3, -5, 0, -4, 0, 1, 1),
                "head": even_curve(2, -6, -15, 2, -12, 2, 3, 2),
            },
            gait=STANDING,
            needed=("hips", "head"),
        ),
        # From the front a nodding head comes down and up again.
        "biped-front": LimbMotion(
            turns={"head": even_curve(0, 1, 1, 0, 0, -1, -1, 0)},
            growth={
                "neck": even_curve(0.02, -0.05, -0.2, -0.03, -0.17, -0.03, -0.01, 0.02),
                "head": even_curve(0.01, -0.02, -0.09, -0.01, -0.08, -0.01, -0.01, 0.01),
            },
            gait=STANDING,
            needed=("hips", "head"),
        ),
    },
)

# Crouch, take off, rise, turn, fall, land, sink and come up; feet stand from landing to take-off.
_LEAP_PHASES = (0.0, 0.2, 0.34, 0.43, 0.53, 0.63, 0.72, 0.84)


def _leap(*values: float) -> Curve:
    return Curve(tuple(zip(_LEAP_PHASES, values, strict=True)))


_LEAP_GAIT = Gait(
    stance=0.62,
    stride=0.0,
    lift=0.26,
    landings=(("foot.L", 0.72), ("foot.R", 0.72)),
    gathered=0.0,
    roll=16,
)
_LEAP = LimbMotion(
    gait=_LEAP_GAIT,
    lag=0.0,
    rise=_leap(0, -0.15, 0.0, 0.24, 0.34, 0.24, 0.0, -0.13),
    leans={
        "chest": _leap(0, -10, 1, 1, 0, -2, -3, -8),
        "head": _leap(0, 7, 3, -1, -4, 0, 3, 6),
        "tail": _leap(0, 8, -8, -10, -5, 4, 10, 8),
    },
    growth={"chest": _leap(0, -0.04, 0.04, 0.02, 0, 0.02, 0.02, -0.05)},
    turns={
        "elbow": _leap(0, -18, 14, 26, 30, 24, 14, -6),
        "hand": _leap(0, 2, 4, 14, 20, 24, 18, 6),
    },
    needed=LEAPERS,
)
# From the front arms rise outwards; they do not swing back through the trunk. Knees would point
# outwards like a frog's: the body sinks less, and feet rise with it.
_LEAP_FRONTAL = replace(
    _LEAP,
    gait=replace(_LEAP_GAIT, lift=0.34, straight=0.997),
    rise=Curve(
        (
            *((0.0, 0.0), (0.2, -0.06), (0.3, -0.03), (0.34, -0.005), (0.38, 0.018), (0.43, 0.13)),
            *((0.53, 0.34), (0.63, 0.13), (0.68, 0.018), (0.72, -0.005), (0.84, -0.05)),
        )
    ),
    turns={
        "head": _leap(0, 1, 0, -1, -1, 0, 1, 1),
        "elbow": _leap(0, 4, 22, 38, 44, 42, 32, 8),
        "hand": _leap(0, -2, -4, 6, 14, 20, 20, 6),
    },
)
JUMP = Motion(
    name="jump",
    label=_("Jump"),
    hint=_("Crouch, leap, land and rise again"),
    seconds=1.25,
    phases=_LEAP_PHASES,
    templates={"biped-side": _LEAP, "biped-front": _LEAP_FRONTAL},
)

# Sunk, pushing, taking off, rising, in the air, falling, landing, sinking.
HOP_PHASES = (0.0, 0.14, 0.28, 0.4, 0.52, 0.64, 0.76, 0.86)


def _hop(*values: float) -> Curve:
    return Curve(tuple(zip(HOP_PHASES, values, strict=True)))


_BOTH_FEET = Gait(
    stance=0.52,
    stride=0.75,
    lift=0.22,
    landings=(("foot.L", 0.76), ("foot.R", 0.76)),
    gathered=0.0,
    roll=20,
)
# Like a kangaroo: both feet land together, the body sinks and is thrown ahead, the tail against it.
LEAPING = LimbMotion(
    gait=_BOTH_FEET,
    lag=0.0,
    rise=_hop(-0.15, -0.1, 0.02, 0.15, 0.2, 0.15, 0.02, -0.09),
    leans={
        "chest": _hop(-7, -6, -3, 0, 2, 3, 2, -3),
        "head": _hop(6, 5, 3, 0, -2, -2, 0, 4),
        "tail": _hop(-8, -10, -4, 6, 12, 12, 8, -2),
    },
    growth={"chest": _hop(-0.04, -0.02, 0.03, 0.02, 0, 0.01, 0.01, -0.03)},
    turns={
        "elbow": _hop(-10, -4, 6, 13, 15, 11, 4, -6),
        "hand": _hop(6, 4, 4, 8, 12, 14, 12, 8),
    },
    needed=LEAPERS,
)
# From the front it hops in place.
LEAPING_FRONTAL = replace(
    LEAPING,
    gait=replace(_BOTH_FEET, stride=0.0, straight=0.997),
    rise=Curve(
        (
            *((0.0, -0.05), (0.14, -0.03), (0.28, -0.005), (0.33, 0.012), (0.4, 0.09)),
            *((0.52, 0.21), (0.64, 0.09), (0.71, 0.012), (0.76, -0.005), (0.86, -0.03)),
        )
    ),
    turns={
        "head": _hop(1, 1, 0, -1, -1, -1, 0, 1),
        "elbow": _hop(2, 6, 16, 26, 30, 28, 20, 8),
        "hand": _hop(8, 0, -4, 2, 10, 16, 18, 14),
    },
)
