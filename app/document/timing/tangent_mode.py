"""How motion passes a key, of a pose or of a track."""

from enum import StrEnum

from app.document.checks import require


class TangentMode(StrEnum):
    """How the motion passes a key; the values are the names in files.

    Through at one velocity, where it comes from one key and goes on to another; in a corner, coming
    and going straight; or with a stop. To hold is to have no motion until the next key.
    """

    SMOOTH = "through"
    CORNER = "corner"
    STOP = "stop"
    HOLD = "hold"


def require_tangent_mode(passing: str) -> None:
    """Raise a `LissomError` unless a key can be passed so; to hold is an easing."""
    require(
        passing in (TangentMode.SMOOTH, TangentMode.CORNER, TangentMode.STOP),
        "A key is passed through, in a corner or with a stop, not "
        f"{str(passing)!r}; to hold is an easing.",
    )
