"""Tangent modes of keys."""

from enum import StrEnum

from app.document.checks import require
from app.texts import N_


class TangentMode(StrEnum):
    """How motion goes through a key; the values are the names in files.

    SMOOTH has one velocity on both sides, CORNER has straight tangents on each side, STOP has zero
    velocity. HOLD keeps the key until the next one.
    """

    SMOOTH = "through"
    CORNER = "corner"
    STOP = "stop"
    HOLD = "hold"


def require_tangent_mode(passing: str) -> None:
    """Refuse unknown tangent modes, and HOLD, which is stored as an easing."""
    require(
        passing in (TangentMode.SMOOTH, TangentMode.CORNER, TangentMode.STOP),
        N_(
            "The tangent of a key must be through, corner or stop, not {tangent!r}; hold is an "
            "easing."
        ),
        tangent=str(passing),
    )
