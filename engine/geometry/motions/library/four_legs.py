"""What goes on four legs."""

from engine.geometry.motions.curves import even
from engine.geometry.motions.limbs import Limbs
from engine.geometry.motions.motion import Motion
from engine.geometry.motions.steps import Gait

FEET = ("hips", "chest")
_TRUNK = {
    "neck": even(2, -2, 2, -2),
    "head": even(-3, 3, -3, 3),
    "tail": even(0, 8, 0, -8),
}

# Four beats: a hind foot, then the front one of its side.
WALK_ON_FOUR = Limbs(
    gait=Gait(
        stance=0.64,
        stride=0.85,
        lift=0.1,
        falls=(("foot.L", 0.0), ("hand.L", 0.25), ("foot.R", 0.5), ("hand.R", 0.75)),
        gathered=0.5,
        roll=20,
    ),
    rise=even(0.0, -0.01, 0.0, 0.01, 0.0, -0.01, 0.0, 0.01),
    turns={**_TRUNK, "chest": even(0, 1, 0, -1)},
    needed=FEET,
)

# Two beats: the feet that are across from each other go together.
TROT = Motion(
    name="trot",
    label="Trot",
    hint="Feet that are across go together, with a spring between",
    seconds=0.75,
    keys=24,
    courses={
        "four-legs": Limbs(
            gait=Gait(
                stance=0.42,
                stride=1.05,
                lift=0.14,
                falls=(("foot.L", 0.0), ("hand.R", 0.0), ("foot.R", 0.5), ("hand.L", 0.5)),
                gathered=0.5,
                roll=28,
            ),
            rise=even(0.0, -0.035, 0.0, 0.035, 0.0, -0.035, 0.0, 0.035),
            turns={
                "neck": even(2, 0, -2, 0, 2, 0, -2, 0),
                "head": even(-2, 2, 2, -2, -2, 2, 2, -2),
                "tail": even(4, 10, 4, -2, 4, 10, 4, -2),
                "chest": even(0, 1, 0, -1, 0, 1, 0, -1),
            },
            needed=FEET,
        )
    },
)
