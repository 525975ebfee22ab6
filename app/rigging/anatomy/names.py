"""Names of suggested handles: by side, or as feet and knees."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

SIDES = (
    "right",
    "upper right",
    "top",
    "upper left",
    "left",
    "lower left",
    "bottom",
    "lower right",
)


class SuggestedHandle(NamedTuple):
    place: complex
    name: str


class Limb(NamedTuple):
    tip: complex
    joints: list[complex]
    is_leg: bool


def name_legs(legs: list[Limb]) -> Iterator[SuggestedHandle]:
    """Yield the handles of legs, named left and right, or numbered from the left."""
    legs = sorted(legs, key=lambda leg: leg.tip.real)
    names = ["left {}", "right {}"]
    if len(legs) != 2:
        names = [f"{{}} {number}" for number in range(1, len(legs) + 1)]
    for leg, name in zip(legs, names, strict=True):
        yield from _named(leg, name, "foot", "knee")


def name_limbs(limbs: list[Limb], middle: complex) -> Iterator[SuggestedHandle]:
    """Yield the handles of other limbs, named by the side of their tips."""
    counts: dict[str, int] = {}
    for limb in sorted(limbs, key=lambda limb: -limb.tip.imag):
        sector = round(float(np.angle(limb.tip - middle)) / (np.pi / 4)) % 8
        side = SIDES[sector]
        counts[side] = counts.get(side, 0) + 1
        number = f" {counts[side]}" if counts[side] > 1 else ""
        yield from _named(limb, f"{side} {{}}{number}", "tip", "bend")


def _named(limb: Limb, name: str, tip: str, joint: str) -> Iterator[SuggestedHandle]:
    yield SuggestedHandle(limb.tip, name.format(tip))
    for letter, place in zip("abc", limb.joints, strict=False):
        one = joint if len(limb.joints) == 1 else f"{joint} {letter}"
        yield SuggestedHandle(place, name.format(one))
