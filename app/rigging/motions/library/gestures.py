"""Motions of bodies that stand: talking, nodding, looking about, breathing and flying."""

from app.rigging.motions.curves import EIGHTHS, ArmDirection, even_curve
from app.rigging.motions.leg_chains import STANDING, LimbMotion
from app.rigging.motions.library.whole_body import BREATHE_WHOLE
from app.rigging.motions.motion import Motion
from app.rigging.motions.steps import Gait
from app.texts import _

HEAD = ("hips", "head")
SPREAD = even_curve(0.8)  # lowered arms beat lower than wings that are drawn spread
IN_THE_AIR = Gait(stance=1.0, stride=0.0, lift=0.0, landings=())
# One hand comes up and beats to the words; the other one answers, lower and later.
_TALKING = {
    "elbow.R": ArmDirection(angle=28, share=even_curve(0, 0.7, 1, 0.9, 1, 0.9, 0.7, 0.3)),
    "hand.R": ArmDirection(
        angle=105,
        share=even_curve(0, 0.5, 1, 1, 1, 1, 0.7, 0.25),
        swing=even_curve(0, 0, 12, -14, 10, -16, 0, 0),
    ),
    "elbow.L": ArmDirection(angle=25, share=even_curve(0, 0, 0.3, 0.6, 0.7, 0.6, 0.4, 0.1)),
    "hand.L": ArmDirection(
        angle=70,
        share=even_curve(0, 0, 0.2, 0.5, 0.7, 0.7, 0.5, 0.2),
        swing=even_curve(0, 0, 0, 6, -8, 6, 0, 0),
    ),
}
_NODDING = {
    "neck": even_curve(0, -0.04, -0.1, 0, -0.09, 0, -0.06, 0),
    "head": even_curve(0, -0.015, -0.04, 0, -0.035, 0, -0.02, 0),
}
TALK = Motion(
    name="talk",
    label=_("Talk"),
    hint=_("The head nods to words, and the hands go along"),
    seconds=2.5,
    phases=EIGHTHS,
    templates={
        "biped-front": LimbMotion(
            turns={"head": even_curve(0, 1, 3, 2, 0, -2, -1, 0)},
            growth=_NODDING,
            aims=_TALKING,
            gait=STANDING,
            needed=HEAD,
        ),
        "biped-side": LimbMotion(
            turns={
                "chest": even_curve(0, -1, -2, -1, -2, -1, -1, 0),
                "head": even_curve(0, -2, -7, 1, -6, 2, -4, 0),
            },
            aims={name: aim for name, aim in _TALKING.items() if name.endswith(".R")},
            gait=STANDING,
            needed=HEAD,
        ),
    },
)
_GLANCE = even_curve(0, 8, 10, 9.5, 1, -8, -9.5, -9)  # to one side, rest, to the other, rest
_LOOKING = {
    "neck": even_curve(0, 4, 5, 5, 0, -4, -5, -4),
    "head": _GLANCE,
    "tail": even_curve(0, -2, -6, -5, -2, 3, 6, 4),
}
LOOK = Motion(
    name="look",
    label=_("Look about"),
    hint=_("The head turns to one side, rests, and turns to the other"),
    seconds=4.0,
    phases=EIGHTHS,
    templates={
        kind: LimbMotion(turns=_LOOKING, gait=STANDING, needed=HEAD)
        for kind in ("biped-front", "biped-side", "four-legs")
    },
)
# In for a bit less than half of the time, out for the rest; the chest leads, the head follows.
_BREATH = even_curve(0, 0.012, 0.03, 0.038, 0.034, 0.022, 0.01, 0.002)
BREATHE = Motion(
    name="breathe",
    label=_("Breathe"),
    hint=_("The body swells and sinks, slowly"),
    seconds=3.0,
    phases=EIGHTHS,
    templates={
        "anything": BREATHE_WHOLE,
        **{
            kind: LimbMotion(
                turns={
                    "chest": even_curve(0, 0.5, 1.2, 1.5, 1.3, 0.8, 0.3, 0),
                    "head": even_curve(0, 0.3, 0, -1, -1.8, -1.5, -0.8, -0.2),
                    "elbow": even_curve(0, 0.5, 2, 3.5, 3.5, 2.5, 1, 0.2),
                    "tail": even_curve(0, 1, 3, 5, 5, 3, 1, 0),
                },
                growth={"chest": _BREATH, "shoulder": _BREATH},
                gait=STANDING,
                lag=0.0,
                needed=HEAD,
            )
            for kind in ("biped-front", "biped-side", "four-legs")
        },
    },
)
_BEAT = even_curve(-2, 0, 2, 2, 2, 0, -2, -2)
_AGAINST_WINGS = even_curve(-0.05, -0.05, 0.0, 0.06, 0.09, 0.06, 0.01, -0.03)
# Wings go up in half of the time and beat down faster; the forearm follows the upper arm.
FLY = Motion(
    name="fly",
    label=_("Fly"),
    hint=_("The arms beat like wings, and the body rises against them"),
    seconds=2 / 3,
    phases=EIGHTHS,
    templates={
        "biped-front": LimbMotion(
            turns={"head": _BEAT, "tail": even_curve(4, 0, -4, -5, -4, 0, 4, 5)},
            aims={
                "elbow": ArmDirection(
                    angle=92, share=SPREAD, swing=even_curve(34, 25, -2, -26, -34, -23, 4, 26)
                ),
                "hand": ArmDirection(
                    angle=96, share=SPREAD, swing=even_curve(38, 46, 26, -12, -42, -52, -28, 14)
                ),
            },
            rise=_AGAINST_WINGS,
            gait=IN_THE_AIR,
            needed=("hips",),
            either=("hand.R", "hand.L"),
        ),
        "biped-side": LimbMotion(
            turns={
                "elbow": even_curve(30, 24, 0, -24, -30, -20, 4, 24),
                "hand": even_curve(6, 22, 26, 14, -6, -22, -26, -14),
                "head": _BEAT,
                "tail": even_curve(4, 0, -4, -5, -4, 0, 4, 5),
            },
            lag=0.0,
            rise=_AGAINST_WINGS,
            gait=IN_THE_AIR,
            needed=("hips",),
            either=("hand.R", "hand.L"),
        ),
    },
)
