"""Legs of a drawing: branches of its skeleton, or what lines part from each other."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from app.rigging.anatomy.skeleton import Branch
from engine.arrays import Complexes, Floats, Indices

# A branch shorter than this, in radii of its root, that thins out this much between a quarter and
# three quarters of its length is a corner, not a leg.
SHORT, CORNER = 1.0, 0.5
# Sideways over downwards: a tail that lies on the ground.
LYING = 1.3
# Heights of ankle and sole above the lowest place of a leg's middle line, in its radii.
ANKLE, SOLE = 1.1, 0.6
BESIDE = 0.6  # of a leg's length: the feet of a pair of legs are this near


class TrackedLeg(NamedTuple):
    """Joints of a leg between lines: where it leaves the body, its knee or hock, and its ankle."""

    root: complex
    knee: complex
    foot: complex


class PlannedLeg(NamedTuple):
    """A leg: the nodes from its root to its end, and its ankle among them."""

    path: Indices
    ankle: int


def plan_leg(branch: Branch, places: Complexes, radii: Floats) -> tuple[PlannedLeg | None, float]:
    """Return a branch as a leg, or None, and its lowest height.

    `places` and `radii` are those of all nodes of the skeleton.
    """
    path = np.array(branch.path)
    places, radii, lengths = places[path], radii[path], np.array(branch.lengths)
    out = lengths[-1] - radii[-1]
    thin, thick = np.interp([0.25 * out, 0.75 * out], lengths, radii)
    lowest = float((places.imag - radii).min())
    if out < lengths[0]:
        return None, lowest  # a corner: it stays in the disc at its root
    radius = float(np.median(radii[lengths <= out]))

    def reaches(height: float) -> int:
        high = places.imag > places.imag.min() + height * radius
        return max(0, int(high.argmax()) - 1)

    ankle, down = reaches(ANKLE), places[-1] - places[reaches(SOLE)]
    is_corner = out <= SHORT * radii[-1] and thin < CORNER * thick
    is_leg = not is_corner and abs(down.real) <= LYING * down.imag
    return (PlannedLeg(path[::-1], int(path[ankle])) if is_leg else None), lowest


def pair_legs(legs: Sequence[TrackedLeg]) -> list[Sequence[TrackedLeg]]:
    """Return three or four legs, from the left, as two pairs; nothing if they are not."""
    if len(legs) not in (3, 4):
        return []
    parted = int(np.diff([leg.foot.real for leg in legs]).argmax()) + 1
    pairs = [legs[:parted], legs[parted:]]
    return [] if max(map(len, pairs)) > 2 else pairs


def are_beside(one: TrackedLeg, other: TrackedLeg) -> bool:
    """Whether two feet are so near to each other that one body stands on them alone."""
    long = min(abs(leg.root - leg.foot) for leg in (one, other))
    return abs(one.foot - other.foot) < BESIDE * long
