"""The legs among the branches of a skeleton."""

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
