"""Domains with holes, and harmonic maps on them."""

from functools import cache
from typing import NamedTuple

import numpy as np
from shapes import regular_polygon

from engine.arrays import Complexes
from engine.geometry import Hole, contains
from engine.maps import Boundary, HarmonicMap


class Holed(NamedTuple):
    """A domain with holes, and where it is anchored."""

    outline: Complexes
    cage: Complexes
    holes: tuple[Hole, ...]
    anchor: complex

    @property
    def loops(self) -> tuple[Complexes, ...]:
        """The outline, then those of the holes."""
        return (self.outline, *(hole.outline for hole in self.holes))

    def moved(self, factor: complex, shift: complex) -> "Holed":
        """Return the same shape elsewhere."""
        return Holed(
            outline=factor * self.outline + shift,
            cage=factor * self.cage + shift,
            holes=tuple(
                Hole(
                    outline=factor * hole.outline + shift,
                    cage=factor * hole.cage + shift,
                    centre=factor * hole.centre + shift,
                )
                for hole in self.holes
            ),
            anchor=factor * self.anchor + shift,
        )


def round_hole(centre: complex, radius: float, sides: int, share: float = 0.82) -> Hole:
    outline = centre + radius * regular_polygon(sides)[::-1]
    return Hole(outline=outline, cage=centre + share * (outline - centre), centre=centre)


@cache
def ring(radius: float = 0.5) -> Holed:
    return Holed(
        outline=regular_polygon(48),
        cage=1.08 * regular_polygon(48),
        holes=(round_hole(0, radius, 36),),
        anchor=0.75 + 0j,
    )


@cache
def plate(count: int = 3) -> Holed:
    """A plate with up to three round holes."""
    corners = np.array([-1.7 - 0.6j, 1.7 - 0.6j, 1.7 + 0.6j, -1.7 + 0.6j])

    def frame(offset: float, pieces: int) -> Complexes:
        grown = corners + offset * np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j])
        along = np.roll(grown, -1) - grown
        return (grown[:, None] + along[:, None] * np.arange(pieces) / pieces).ravel()

    centres, radii = (-1.1, 0.05, 1.1), (0.28, 0.36, 0.22)
    return Holed(
        outline=frame(0.0, 12),
        cage=frame(0.06, 12),
        holes=tuple(
            round_hole(c, r, 24) for c, r in list(zip(centres, radii, strict=True))[:count]
        ),
        anchor=-0.55 + 0j,
    )


@cache
def boundary_of(shape: str, count: int = 1) -> Boundary:
    """Return the boundary of the ring, or of the plate with so many holes."""
    domain = ring() if shape == "ring" else plate(count)
    return Boundary.sample(domain.outline, domain.cage, domain.holes)


def inner_points(shape: Holed, count: int = 300, seed: int = 0) -> Complexes:
    """Return points of a domain that keep clear of its boundary."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(shape.outline.real.min(), shape.outline.real.max(), count)
    y = rng.uniform(shape.outline.imag.min(), shape.outline.imag.max(), count)
    points = 0.97 * (x + 1j * y)
    grown = [hole.centre + 1.05 * (hole.outline - hole.centre) for hole in shape.holes]
    return points[contains(shape.outline, points, holes=grown)]


def random_map(shape: Holed, seed: int, size: float = 0.05) -> HarmonicMap:
    """A smooth map near the identity, with a logarithm for every hole."""
    rng = np.random.default_rng(seed)

    def smooth() -> Complexes:
        a, b = rng.normal(size=2) + 1j * rng.normal(size=2)
        parts = [a * shape.cage**2 / 4 + b * shape.cage**3 / 12]
        for hole in shape.holes:
            a, b = rng.normal(size=2) + 1j * rng.normal(size=2)
            w = hole.cage - hole.centre
            scale = np.abs(w).max()
            parts.append(a * scale**2 / w / 2 + b * scale**3 / w**2 / 6)
        return np.concatenate(parts)

    identity = HarmonicMap.identity(shape.cage, shape.holes)
    return HarmonicMap(
        cage=shape.cage,
        phi=identity.phi + size * smooth(),
        psi=size * smooth(),
        holes=shape.holes,
        logs=size * 0.2 * (rng.normal(size=len(shape.holes)) + 1j),
    )
