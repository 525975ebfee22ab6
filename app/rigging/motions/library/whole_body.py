"""Motions of bodies without joints."""

from app.rigging.motions.curves import EIGHTHS, Curve, Leap, even_curve
from app.rigging.motions.library.bipeds import HOP_PHASES, LEAPING, LEAPING_FRONTAL
from app.rigging.motions.motion import Motion
from app.rigging.motions.squash_stretch import SquashStretch
from app.texts import _

BREATHE_WHOLE = SquashStretch(
    swell=even_curve(0.0, 0.04, 0.08, 0.065, 0.03, 0.005),
    stretch=even_curve(0.0, 0.01, 0.02, 0.018, 0.008, 0.0),
)

SWAY = Motion(
    name="sway",
    label=_("Sway"),
    hint=_("The body leans from side to side on its foot, as in the wind"),
    seconds=2.5,
    phases=EIGHTHS,
    templates={
        "anything": SquashStretch(
            lean=even_curve(0.0, 11, 13, 0.0, -11, -13), stretch=even_curve(0, -0.01, -0.01)
        )
    },
)

HOP = Motion(
    name="hop",
    label=_("Hop"),
    hint=_(
        "The body leaves the ground and lands, with both feet at once, or squashed and stretched"
    ),
    seconds=1.0,
    phases=HOP_PHASES,
    templates={
        "biped-side": LEAPING,
        "biped-front": LEAPING_FRONTAL,
        "anything": SquashStretch(
            stretch=Curve(
                (
                    (0.0, -0.02),
                    (0.14, -0.22),
                    (0.3, 0.1),
                    (0.4, 0.14),
                    (0.53, 0.02),
                    (0.7, 0.1),
                    (0.82, -0.2),
                )
            ),
            rise=Leap(0.28, 0.76, 0.3),
        ),
    },
)
