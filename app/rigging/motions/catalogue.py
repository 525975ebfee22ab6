"""Motions by their names."""

from app.rigging.motions.library.table import MOTIONS
from app.rigging.motions.motion import Motion
from engine.errors import EngineError


def find_motion(name: str) -> Motion:
    """Return the motion with this name; raise an `EngineError` if there is none."""
    if name not in MOTIONS:
        raise EngineError(
            "There is no motion preset {name!r}; choose one of {motions}.",
            name=name,
            motions=", ".join(MOTIONS),
        )
    return MOTIONS[name]
