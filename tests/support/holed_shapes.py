"""Domains with holes, and harmonic maps on them."""

from functools import cache
from typing import NamedTuple

import numpy as np
from shapes import regular_polygon

from engine.arrays import Complexes
from engine.deform import Deformer, Handles, State
from engine.geometry import Domain, Hole, contains
from engine.maps import Boundary, Bounds, HarmonicMap


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

    @property
    def domain(self) -> Domain:
        return Domain(self.outline, self.cage, self.holes)

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
def ring(radius: float = 0.5, sides: int = 48) -> Holed:
    return Holed(
        outline=regular_polygon(sides),
        cage=1.08 * regular_polygon(sides),
        holes=(round_hole(0, radius, 3 * sides // 4),),
        anchor=0.75 + 0j,
    )


@cache
def plate(count: int = 3, pieces: int = 12) -> Holed:
    """A plate with up to three round holes; each of its edges is in so many pieces."""
    corners = np.array([-1.7 - 0.6j, 1.7 - 0.6j, 1.7 + 0.6j, -1.7 + 0.6j])

    def frame(offset: float, pieces: int) -> Complexes:
        grown = corners + offset * np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j])
        along = np.roll(grown, -1) - grown
        return (grown[:, None] + along[:, None] * np.arange(pieces) / pieces).ravel()

    centres, radii = (-1.1, 0.05, 1.1), (0.28, 0.36, 0.22)
    return Holed(
        outline=frame(0.0, pieces),
        cage=frame(0.06, pieces),
        holes=tuple(
            round_hole(c, r, 2 * pieces) for c, r in list(zip(centres, radii, strict=True))[:count]
        ),
        anchor=-0.55 + 0j,
    )


@cache
def boundary_of(shape: str, count: int = 1) -> Boundary:
    """Return the boundary of the ring, or of the plate with so many holes."""
    domain = ring() if shape == "ring" else plate(count)
    return Boundary.sample(domain.domain)


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


def on_circle(radius, degrees):
    return radius * np.exp(1j * np.deg2rad(np.array(degrees)))


AROUND = on_circle(0.75, np.arange(0, 360, 45))
BOTH = np.concatenate([on_circle(0.9, [0, 90, 180, 270]), on_circle(0.58, [0, 90, 180, 270])])
KIDNEY = np.array(
    [0.75, 0.55 + 0.6j, 0.1 + 0.8j, -0.3 + 0.5j, -0.15, -0.3 - 0.5j, 0.1 - 0.8j, 0.55 - 0.6j]
)
CRESCENT = np.array(
    [1, 1 + 0.9j, 0.2 + 1.1j, -0.9 + 1j, -1.3 + 0.3j, -0.8 + 0.25j, -0.1 + 0.1j, 0.6 - 0.3j]
)
EGG = np.array([1.3, 0.2 + 0.6j, -0.6, 0.3 - 0.9j])
SWIRL = np.concatenate([BOTH[:4] * np.exp(0.3j), BOTH[4:] * np.exp(-0.3j) + 0.12 + 0.1j])
# Handles on the ring, and where they are pulled.
DRAGS = {
    "kidney": (AROUND, KIDNEY),
    "egg": (on_circle(0.75, [0, 90, 180, 270]), EGG),
    "crescent": (AROUND, CRESCENT),
    "swirl": (BOTH, SWIRL),
}
ON_PLATE = np.array(
    [
        -1.55,
        -0.55 + 0.45j,
        -0.55 - 0.45j,
        0.55 + 0.45j,
        0.55 - 0.45j,
        1.55,
        -1.1 + 0.45j,
        1.1 - 0.45j,
    ]
)
# The plate's handles, bent by 160° and twisted.
PLATE_DRAGS = {
    "bent": 1.2j + (1.2 - ON_PLATE.imag) * np.exp(1j * (ON_PLATE.real / 1.2 - np.pi / 2)),
    "twisted": ON_PLATE * np.exp(0.35j * ON_PLATE.real) + 0.3 * (np.arange(8) == 5),
}


@cache
def pulled(name: str) -> State:
    """Return the ring or the plate with its handles pulled as one of the drags says."""
    if name in DRAGS:
        boundary, (points, targets) = boundary_of("ring"), DRAGS[name]
    else:
        boundary, points, targets = boundary_of("plate", 3), ON_PLATE, PLATE_DRAGS[name]
    deformer = Deformer(boundary=boundary, handles=Handles.place(boundary, points), bounds=Bounds())
    state, _ = deformer.settle(deformer.start(), deformer.handles.targets(targets))
    return state
