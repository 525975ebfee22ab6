"""A hole of a region, with the polygon in it that carries coordinates."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import Complexes, as_points
from engine.errors import EngineError
from engine.geometry.polygon import contains, lies_within, require_holes, require_simple


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Hole:
    """A hole of a domain.

    Parameters
    ----------
    outline : complex128, shape (n,)
        Simple, clockwise: the domain lies on its left.
    cage : complex128, shape (n,)
        Simple, clockwise, strictly inside the outline, one vertex for each of its own.
    centre : complex
        c, a point inside the cage: where the map's term ln |z - c| is singular.

    Raises
    ------
    EngineError
        If these are not finite numbers.
    """

    outline: Complexes
    cage: Complexes
    centre: complex

    def __post_init__(self) -> None:
        for name in ("outline", "cage"):
            values = as_points(getattr(self, name), f"{name} of a hole")
            object.__setattr__(self, name, values)
        (centre,) = as_points([self.centre], "centre of a hole")
        object.__setattr__(self, "centre", complex(centre))

    def moved(self, shift: complex, scale: float = 1.0) -> "Hole":
        """Return the hole scaled about the origin, and then shifted."""
        outline, cage = shift + scale * self.outline, shift + scale * self.cage
        return Hole(outline=outline, cage=cage, centre=shift + scale * self.centre)


def require_cages_in_holes(holes: Sequence[Hole], outline: Complexes) -> None:
    """Raise `EngineError` unless the holes lie apart inside the outline, each with a cage in it."""
    require_holes([hole.outline for hole in holes], outline)
    for number, hole in enumerate(holes):
        require_simple(hole.cage, f"cage of hole {number}", clockwise=True)
        if not lies_within(hole.cage, hole.outline):
            raise EngineError(
                "The cage of hole {number} is not inside the hole; move it strictly inside.",
                number=number,
            )
        if not contains(hole.cage, np.array([hole.centre])).all():
            raise EngineError("The centre of hole {number} is not inside its cage.", number=number)
