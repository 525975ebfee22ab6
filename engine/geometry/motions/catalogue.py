"""Motions by their names."""

from engine.errors import EngineError
from engine.geometry.motions.library.table import MOTIONS
from engine.geometry.motions.motion import Motion


def find_motion(name: str) -> Motion:
    """Return the motion with this name; raise an `EngineError` if there is none."""
    if name not in MOTIONS:
        raise EngineError(f"there is no motion {name!r}; the motions are {', '.join(MOTIONS)}")
    return MOTIONS[name]
