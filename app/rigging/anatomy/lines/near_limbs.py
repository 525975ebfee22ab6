"""Which limb of a pair is nearer to the viewer, in a drawing seen from the side."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from app.rigging.motions.body import other_side, without_side
from app.rigging.motions.kinds import near_side
from engine.arrays import Bytes, Complexes, Floats
from engine.geometry import arc_lengths, distance_to_boundary

LIMBS = (("hip", "knee", "foot"), ("shoulder", "elbow", "hand"))
SAMPLES = 40  # along a limb
ROOT = 0.35  # of a limb from its root on: there the near limb's outline crosses the far limb
INK = 0.5  # of the usual brightness: a line
# Weights of the signs, each from -1 to 1: of lines across the root, of brightness, of feet that
# stand lower in the picture, and of thickness.
OVERLAP, SHADE, LOWER, THICK = 1.0, 2.0, 1.0, 1.5
# Differences that count fully: of brightness (share), of feet in lengths of a leg, of thickness.
SHADED, LOWERED, THICKER = 0.12, 0.04, 0.3
SURE = 0.5  # of the sum of the signs


class NearLimb(NamedTuple):
    """Guess of one pair of limbs: the joint at the end of the near limb."""

    near: str
    is_sure: bool


def guess_near_limbs(
    loops: Sequence[Complexes], joints: Mapping[str, complex], rgba: Bytes, corner: complex
) -> tuple[NearLimb, ...]:
    """Return the nearer limb of each pair that is complete.

    Parameters
    ----------
    loops : sequence of complex128
        The outline and the outlines of the holes; y up.
    joints : mapping of str to complex
        Places of the joints.
    rgba : uint8, shape (h, w, 4)
        The picture.
    corner : complex
        Its lower left corner.
    """
    found = []
    for names in LIMBS:
        limbs = [[joints.get(f"{name}.{side}") for name in names] for side in "LR"]
        ways = [[place for place in limb if place is not None] for limb in limbs]
        ends = [limb[-1] for limb in limbs]
        if None in ends or min(map(len, ways)) < 2:
            continue
        one, other = (_Limb(loops, way, rgba, corner) for way in ways)
        score = one.score_against(other)
        near = f"{names[-1]}.{'L' if score >= 0 else 'R'}"
        found.append(NearLimb(near, abs(score) >= SURE))
    return tuple(found)


def swap_limbs(joints: Mapping[str, complex], end: str) -> dict[str, complex]:
    """Return the joints with the sides of the pair of limbs that ends at a joint swapped."""
    pair = next(names for names in LIMBS if names[-1] == without_side(end))
    return {
        other_side(name) if without_side(name) in pair else name: place
        for name, place in joints.items()
    }


def name_near_limbs(
    joints: Mapping[str, complex], found: Sequence[NearLimb], facing: int
) -> dict[str, complex]:
    """Return the joints with near limbs named after the near side of a body."""
    named = dict(joints)
    for limb in found:
        if not limb.near.endswith(near_side(facing)):
            named = swap_limbs(named, limb.near)
    return named


class _Limb:
    """A limb of a drawing, and how it looks along its axis."""

    def __init__(
        self, loops: Sequence[Complexes], way: Sequence[complex], rgba: Bytes, corner: complex
    ) -> None:
        places = np.array(way)
        lengths = arc_lengths(places)
        shares = np.linspace(0.0, 1.0, SAMPLES)
        at = np.interp(shares * lengths[-1], lengths, places.real) + 1j * np.interp(
            shares * lengths[-1], lengths, places.imag
        )
        self.length, self.end = float(lengths[-1]), complex(way[-1])
        self.brightness = _brightness(rgba, at - corner)
        below = shares > ROOT
        self.usual = float(np.median(self.brightness[below]))
        self.radius = float(np.median(distance_to_boundary(loops[0], at[below], loops[1:])))
        low = loops[0][np.abs(loops[0] - self.end) < self.length / 3]
        self.lowest = float(low.imag.min()) if len(low) else self.end.imag

    @property
    def has_line(self) -> bool:
        """Whether a dark line crosses the limb near its root."""
        root = self.brightness[: int(ROOT * SAMPLES)]
        return bool((root < INK * self.usual).any())

    def score_against(self, other: "_Limb") -> float:
        """Return how much nearer this limb seems than the other, below 0 if it seems farther."""
        shade = (self.usual - other.usual) / max(self.usual, other.usual, 1e-9)
        length = (self.length + other.length) / 2
        thick = (self.radius - other.radius) / max(self.radius, other.radius)
        return (
            OVERLAP * (other.has_line - self.has_line)
            + SHADE * _clip(shade / SHADED)
            + LOWER * _clip((other.lowest - self.lowest) / (LOWERED * length))
            + THICK * _clip(thick / THICKER)
        )


def _clip(value: float) -> float:
    return min(max(value, -1.0), 1.0)


def _brightness(rgba: Bytes, places: Complexes) -> Floats:
    """Return the brightness of a picture at places, in pixels from its lower left corner."""
    height, width = rgba.shape[:2]
    column = np.clip(places.real.astype(int), 0, width - 1)
    row = np.clip((height - places.imag).astype(int), 0, height - 1)
    return np.asarray(rgba[row, column, :3].mean(axis=1), np.float64)
