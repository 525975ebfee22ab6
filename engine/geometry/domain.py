"""The plane domain of maps, as all rooms above use it."""

from dataclasses import dataclass, replace
from typing import Self

from engine.arrays import Booleans, Complexes, as_points, as_tuple, require_kind
from engine.geometry.hole import Hole
from engine.geometry.polygon import contains


@dataclass(frozen=True, slots=True, weakref_slot=True, eq=False)
class Domain:
    """A polygon less its holes, with the cages of the Cauchy coordinates.

    `engine.maps.Boundary.sample` checks that outline, cage and holes belong together.

    Parameters
    ----------
    outline : complex128, shape (p,)
        Simple, counter-clockwise. The domain is its inside less the holes.
    cage : complex128, shape (n,)
        Counter-clockwise around the outline. It may cross itself away from the outline, as some
        published cages do.
    holes : tuple of Hole
        Their outlines are the rest of the boundary; their cages carry coordinates of their own.

    Raises
    ------
    EngineError
        If a polygon has fewer than three finite complex numbers, or a hole is no `Hole`.
    """

    outline: Complexes
    cage: Complexes
    holes: tuple[Hole, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "outline", as_points(self.outline, "outline", at_least=3))
        object.__setattr__(self, "cage", as_points(self.cage, "cage", at_least=3))
        object.__setattr__(self, "holes", as_tuple(self.holes, "holes"))
        for number, hole in enumerate(self.holes):
            require_kind(hole, Hole, f"hole {number}")

    @property
    def loops(self) -> tuple[Complexes, ...]:
        """The polygons of the boundary: the outline, then those of the holes."""
        return (self.outline, *(hole.outline for hole in self.holes))

    @property
    def cages(self) -> tuple[Complexes, ...]:
        """The polygons of the Cauchy coordinates: the outline's cage, then those in the holes."""
        return (self.cage, *(hole.cage for hole in self.holes))

    def contains(self, points: Complexes) -> Booleans:
        """Return for each point (m,) whether it lies in the domain."""
        return contains(self.outline, points, holes=self.loops[1:])

    def moved(self, by: complex) -> Self:
        holes = tuple(hole.moved(by) for hole in self.holes)
        return replace(self, outline=self.outline + by, cage=self.cage + by, holes=holes)
