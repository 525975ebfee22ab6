"""Inverse kinematics of a chain of bones: its joints from its root and the goal of its end.

A chain of two bones has two solutions, on either side of the way from root to goal; the side is
given. A chain of more bones has many: the nearest to its present joints is found by FABRIK
(Aristidou and Lasenby 2011). Beyond reach a chain is straight, and its end stays on the circle.
Nearer than its bones can fold, its end stays on the circle of the sharpest fold.
"""

import cmath
import math
from collections.abc import Sequence
from itertools import accumulate

# Bend of a joint beyond which a chain does not fold, in radians.
SHARPEST_BEND = math.radians(150)
SWEEPS = 60  # of FABRIK
HALVINGS = 60  # in the search for an even bend
TOLERANCE = 1e-10  # of the chain's length
# A chain whose joints bend by less counts as straight: its sides are the given ones.
STRAIGHT = math.radians(4)


def solve_chain(
    root: complex, lengths: Sequence[float], goal: complex, start: Sequence[complex], side: int
) -> list[complex]:
    """Return the places of the joints after the root, the end last.

    Parameters
    ----------
    lengths : sequence of float
        Of the bones.
    start : sequence of complex
        Present places of the same joints.
    side : int
        1 if the joints bend to the left of the way from root to end, -1 to the right.
    """
    goal = clamp_goal(root, lengths, goal, start[-1])
    if len(lengths) == 1:
        return [goal]
    if len(lengths) == 2:
        return [_middle(root, goal, lengths[0], lengths[1], side), goal]
    places = [root, *start]
    triples = zip(places, places[1:], places[2:], strict=False)
    is_bent = any(bend_side(*triple) for triple in triples)
    if is_bent and abs(goal - root) < (1 - TOLERANCE) * sum(lengths):
        return _fabrik(root, lengths, goal, start)
    return _evenly_bent(root, lengths, goal, side)


def clamp_goal(root: complex, lengths: Sequence[float], goal: complex, present: complex) -> complex:
    """Return the goal, or the nearest place on the circles that the chain's end can reach."""
    way = goal - root
    if way == 0:
        way = present - root or 1.0
    nearest, farthest = reach(lengths)
    return root + way / abs(way) * min(max(abs(goal - root), nearest), farthest)


def reach(lengths: Sequence[float]) -> tuple[float, float]:
    """Return the least and the largest distance of a chain's end from its root."""
    whole = sum(lengths)
    if len(lengths) == 1:
        return whole, whole
    if len(lengths) == 2:
        first, second = lengths
        return abs(
            first + second * complex(math.cos(SHARPEST_BEND), math.sin(SHARPEST_BEND))
        ), whole
    return max(2 * max(lengths) - whole, 0.0), whole


def bend_side(root: complex, joint: complex, end: complex) -> int:
    """Return the side to which a joint bends, and 0 if the chain is about straight."""
    first, second = joint - root, end - joint
    across = (first.conjugate() * second).imag
    if abs(across) <= math.sin(STRAIGHT) * abs(first) * abs(second):
        return 0
    return -1 if across > 0 else 1


def _middle(root: complex, goal: complex, first: float, second: float, side: int) -> complex:
    """Return the joint of two bones whose goal is within reach."""
    distance = abs(goal - root)
    along = (distance**2 + first**2 - second**2) / (2 * distance)
    across = math.sqrt(max(first**2 - along**2, 0.0))
    return root + (goal - root) / distance * complex(along, side * across)


def _evenly_bent(
    root: complex, lengths: Sequence[float], goal: complex, side: int
) -> list[complex]:
    """Return the joints of a chain that bends by the same angle at each of them."""
    low, high = 0.0, 2 * math.pi / len(lengths)
    for _ in range(HALVINGS):
        bend = (low + high) / 2
        if abs(_with_bend(lengths, bend)[-1]) > abs(goal - root):
            low = bend
        else:
            high = bend
    # Bends to the right leave the joints on the left of the way.
    places = [place.conjugate() if side > 0 else place for place in _with_bend(lengths, low)]
    turn = (goal - root) / abs(goal - root) * abs(places[-1]) / places[-1]
    return [root + turn * place for place in places]


def _with_bend(lengths: Sequence[float], bend: float) -> list[complex]:
    """Return the joints of a chain from 0, each bone turned by an angle against the last."""
    ways = (length * cmath.rect(1.0, bend * i) for i, length in enumerate(lengths))
    return list(accumulate(ways))


def _fabrik(
    root: complex, lengths: Sequence[float], goal: complex, start: Sequence[complex]
) -> list[complex]:
    places = [root, *start]
    for _ in range(SWEEPS):
        if abs(places[-1] - goal) <= TOLERANCE * sum(lengths):
            break
        places[-1] = goal
        for i in range(len(lengths) - 1, 0, -1):
            places[i] = _at_distance(places[i + 1], places[i], lengths[i])
        for i, length in enumerate(lengths):
            places[i + 1] = _at_distance(places[i], places[i + 1], length)
    return places[1:]


def _at_distance(centre: complex, place: complex, distance: float) -> complex:
    way = place - centre
    return centre + (way / abs(way) if way else 1.0) * distance
