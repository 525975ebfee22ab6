"""Motions of bodies that stand: talking, looking about, breathing and flying."""

from app.rigging.motions.curves import EIGHTHS, even_curve
from app.rigging.motions.leg_chains import STANDING, LimbMotion
from app.rigging.motions.library.whole_body import BREATHE_WHOLE
from app.rigging.motions.motion import Motion
from app.rigging.motions.steps import Gait
from app.texts import _

HEAD = ("hips", "head")
IN_THE_AIR = Gait(stance=1.0, stride=0.0, lift=0.0, landings=())
_HANDS_TALK = {"elbow": even_curve(0, 4, 8, 5, 2, 6, 9, 3), "hand": even_curve(0, 9, 18, 8)}
TALK = Motion(
    name="talk",
    label=_("Talk"),
    hint=_("The head nods to words, and the hands go along"),
    seconds=2.0,
    phases=EIGHTHS,
    templates={
        kind: LimbMotion(
            turns={
                "chest": even_curve(0, -1, 0, 1, 0, -1, -2, -1),
                "head": even_curve(0, 4, -2, 3, -1, 5, 1, -2),
                **_HANDS_TALK,
            },
            lag=0.25,
            needed=HEAD,
        )
        for kind in ("biped-front", "biped-side")
    },
)
LOOK = Motion(
    name="look",
    label=_("Look about"),
    hint=_("The head turns to one side, rests, and turns to the other"),
    seconds=4.0,
    phases=EIGHTHS,
    templates={
        kind: LimbMotion(
            turns={
                "chest": even_curve(0, 1, 2, 1, 0, -1, -2, -1),
                "neck": even_curve(0, 4, 5, 4, 0, -4, -5, -4),
                "head": even_curve(0, 9, 11, 9, 0, -8, -10, -8),
                "tail": even_curve(0, -4, -6, -4, 0, 4, 6, 4),
            },
            gait=STANDING,
            needed=HEAD,
        )
        for kind in ("biped-front", "biped-side", "four-legs")
    },
)
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
                rise=even_curve(-0.02, -0.012, 0.004, 0.016, 0.02, 0.012, -0.004, -0.016),
                turns={
                    "chest": even_curve(0, 1, 2, 2.5, 2, 1, 0, -0.5),
                    "head": even_curve(0, -1, -2, -2.5, -2, -1, 0, 0.5),
                    "elbow": even_curve(0, 1, 3, 4, 3, 1, 0, -1),
                    "tail": even_curve(0, 2, 4, 5, 4, 2, 0, -1),
                },
                lag=0.0,
                needed=HEAD,
            )
            for kind in ("biped-front", "biped-side")
        },
    },
)
FLY = Motion(
    name="fly",
    label=_("Fly"),
    hint=_("The arms beat like wings, and the body rises against them"),
    seconds=2 / 3,
    phases=EIGHTHS,
    templates={
        kind: LimbMotion(
            turns={
                "elbow": even_curve(30, 24, 0, -24, -30, -20, 4, 24),
                "hand": even_curve(6, 22, 26, 14, -6, -22, -26, -14),
                "head": even_curve(-2, 0, 2, 2, 2, 0, -2, -2),
                "tail": even_curve(4, 0, -4, -5, -4, 0, 4, 5),
            },
            lag=0.0,
            rise=even_curve(-0.04, -0.05, 0.0, 0.05, 0.08, 0.06, 0.02, -0.02),
            gait=IN_THE_AIR,
            needed=("hips",),
            either=("hand.R", "hand.L"),
        )
        for kind in ("biped-front", "biped-side")
    },
)
