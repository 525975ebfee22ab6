"""Ties across the drawn line near joints, which keep its thickness where a limb bends.

A harmonic map that bends a strip of half width w by the angle θ along a length ℓ stretches the
outer side across by about 2 w θ / ℓ more than the inner one: with f = e^{iax} r(y), a = θ / ℓ, it
is r″ = a² r, and so r′(w) − r′(−w) = a² ∫ r ≈ 2 w a. A bend of 100° along ℓ = 2 w leaves .87 on
each side: the line becomes about twice as thick outside. Ties let the inner side give way instead,
and spread the bend evenly.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.domain.material.shafts import joint_share
from engine.geometry import contains

# In half widths of the limb: between ties along the outline, their distance from it, their depth.
SPACING, INSET, DEPTH = 0.3, 0.02, 0.15


class BendingPlace(NamedTuple):
    """A place at which a limb of this half width bends."""

    place: complex
    half_width: float


class LineTies(NamedTuple):
    """Ties from places next to the outline inwards, and how much each counts, (k,) each.

    The share is the part of all outlines' length that the tie stands for, less far from a joint.
    """

    starts: Complexes
    ends: Complexes
    shares: Floats


def tie_lines(loops: Sequence[Complexes], bending: Sequence[BendingPlace]) -> LineTies:
    """Return ties across the line around places where limbs bend; each side of a loop once."""
    sides = [np.roll(loop, -1) - loop for loop in loops]
    whole = sum(float(np.abs(side).sum()) for side in sides)
    from_corners, ways = np.concatenate(list(loops)), np.concatenate(sides)
    spacings = np.full(len(ways), np.inf)
    for place, half_width in bending:
        is_near = joint_share(from_corners + ways / 2, place, half_width) > 0
        spacings[is_near] = np.minimum(spacings[is_near], half_width)
    near = np.flatnonzero(np.isfinite(spacings) & (ways != 0))
    counts = np.ceil(np.abs(ways[near]) / (SPACING * spacings[near])).astype(np.intp)
    numbers = np.repeat(near, counts)
    steps = np.arange(len(numbers)) - np.repeat(np.cumsum(counts) - counts, counts) + 0.5
    parts = np.repeat(counts, counts)
    places = from_corners[numbers] + steps / parts * ways[numbers]
    inwards = 1j * ways[numbers] / np.abs(ways[numbers]) * spacings[numbers]
    starts, ends = places + INSET * inwards, places + (INSET + DEPTH) * inwards
    shares = np.zeros(len(places))
    for place, half_width in bending:
        shares = np.maximum(shares, joint_share(places, place, half_width))
    shares *= np.abs(ways[numbers]) / parts / whole
    is_tie = (shares > 0) & contains(loops[0], ends, holes=loops[1:])
    is_tie &= contains(loops[0], starts, holes=loops[1:])
    return LineTies(starts[is_tie], ends[is_tie], shares[is_tie])
