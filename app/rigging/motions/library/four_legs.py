"""Motions of four-legged bodies."""

from app.rigging.motions.curves import EIGHTHS, Curve, even_curve
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

# Two beats: diagonal feet move together. Contact, down, push-off and a short flight, on each side.
_TROT_PHASES = (0.0, 0.15, 0.3, 0.4, 0.5, 0.65, 0.8, 0.9)


def _trot(*values: float) -> Curve:
    """Return a curve with the same values in both halves of the cycle."""
    return Curve(tuple(zip(_TROT_PHASES, 2 * values, strict=True)))


TROT = Motion(
    name="trot",
    label=_("Trot"),
    hint=_("Diagonal feet step together, with a bounce between the steps"),
    seconds=0.75,
    phases=_TROT_PHASES,
    templates={
        "four-legs": LimbMotion(
            gait=Gait(
                stance=0.3,
                stride=1.9,
                landings=(("foot.L", 0.0), ("hand.R", 0.0), ("foot.R", 0.5), ("hand.L", 0.5)),
                gathered=0.7,
                roll=35,
                fold=0.26,
                crest=0.42,
                follow=0.5,
                straight=0.99,
            ),
            rise=_trot(0.0, -0.04, 0.0, 0.05),
            turns={
                "neck": _trot(2, 0, -2, 0),
                "head": _trot(-2, 2, 2, -2),
                "tail": _trot(4, 10, 4, -2),
                "chest": _trot(0, 1, 0, -1),
            },
            needed=FEET,
        )
    },
)

# One hind foot after the other, in the air with legs apart, one front foot after the other, and in
# the air with legs gathered below the body.
GALLOP = Motion(
    name="gallop",
    label=_("Gallop"),
    hint=_("Hind feet, then front feet, with a moment in the air after each pair"),
    seconds=2 / 3,
    phases=EIGHTHS,
    templates={
        "four-legs": LimbMotion(
            gait=Gait(
                stance=0.125,
                stride=3.2,
                landings=(("foot.L", 0.0), ("foot.R", 0.125), ("hand.L", 0.5), ("hand.R", 0.625)),
                gathered=1.0,
                roll=40,
                fold=0.2,
                behind=0.15,
                straight=0.99,
            ),
            rise=even_curve(-0.02, -0.03, 0.01, 0.05, 0.0, -0.02, 0.0, 0.03),
            turns={
                "neck": even_curve(3, 1, -2, -5, -4, -1, 2, 4),
                "head": even_curve(-2, 0, 2, 4, 3, 0, -2, -3),
                "tail": even_curve(4, 8, 10, 6, 0, -6, -4, 0),
                "chest": even_curve(2, 4, 4, 1, -3, -5, -4, -1),
            },
            needed=FEET,
        )
    },
)
