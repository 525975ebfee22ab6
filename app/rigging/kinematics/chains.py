"""Inverse kinematics of a chain of bones: its joints from its root and the goal of its end.

A chain of two bones has two solutions, on either side of the way from root to goal; the side is
given. A chain of more bones has many: the one whose bends change least is taken, so that all joints
share a bend, and clearly bent ones keep their side. Beyond reach a chain is straight, and its end
stays on the circle.
Nearer than its bones can fold, its end stays on the circle of the sharpest fold.
"""

import cmath
import math
from collections.abc import Sequence
from itertools import accumulate

import numpy as np

from engine.arrays import Booleans, Complexes, Floats

# Bend of a joint beyond which a chain does not fold, in radians.
SHARPEST_BEND = math.radians(150)
CLEARLY_BENT = math.radians(20)  # joints that bend by more keep their side
STRIDE = 0.3  # radians: largest change of a bend in a step
SWEEPS = 25  # steps at the goal
SETTLED = 1e-7  # radians
LEAST_CURVATURE = 0.2
MISSED = 1e-6  # of the chain's length
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
        found = _least_changed(root, lengths, goal, start)
        if found is not None:
            return found
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


def _least_changed(
    root: complex, lengths: Sequence[float], goal: complex, start: Sequence[complex]
) -> list[complex] | None:
    """Return the joints of the chain whose bends change least, or None if it misses the goal.

    Joints that are clearly bent keep their side, if the goal can be reached so. The end goes from
    its place to the goal around the root, by steps of Newton's method for the least squares.
    """
    ways = np.diff(np.array([root, *start]))
    bends = np.angle(ways / np.array([1.0, *ways[:-1]]))
    most = np.maximum(np.abs(bends), SHARPEST_BEND)
    most[0] = np.inf
    keeps = np.abs(bends) > CLEARLY_BENT
    keeps[0] = False
    ranges = np.where(keeps & (bends > 0), 0.0, -most), np.where(keeps & (bends < 0), 0.0, most)
    spans = np.asarray(lengths, np.float64)
    for low, high in (ranges, (np.full(len(bends), -np.inf), np.full(len(bends), np.inf))):
        found = _follow(bends, spans, goal - root, low, high)
        places = np.cumsum(spans * np.exp(1j * np.cumsum(found)))
        if abs(places[-1] - (goal - root)) <= MISSED * spans.sum():
            # Exactly the goal: a pose at rest is at rest for its own end, too.
            return [*(root + complex(place) for place in places[:-1]), goal]
    return None


def _follow(drawn: Floats, lengths: Floats, goal: complex, low: Floats, high: Floats) -> Floats:
    """Return the bends (n,), nearest to the drawn ones, that bring a chain's end to a goal.

    The first bend is the first bone's direction. All stay between `low` and `high`.
    """
    bends, tiny = drawn.copy(), TOLERANCE * lengths.sum()
    here = complex(np.sum(lengths * np.exp(1j * np.cumsum(drawn))))
    way = cmath.log(goal / here) if abs(here) > tiny < abs(goal) else 0j
    steps = 1 + math.ceil(abs(way) / STRIDE)
    for step in range(1, steps + 1):
        target = here * cmath.exp(way * (step / steps)) if step < steps else goal
        for _ in range(SWEEPS if step == steps else 1):
            reached = np.cumsum(lengths * np.exp(1j * np.cumsum(bends)))
            arms = reached[-1] - np.concatenate([[0], reached[:-1]])
            miss = target - complex(reached[-1])
            change = _change(arms, bends - drawn, miss, bends <= low, bends >= high)
            size = float(np.abs(change).max())
            bends = np.clip(bends + change * min(1.0, STRIDE / (size or 1.0)), low, high)
            if size < SETTLED and abs(miss) < tiny:
                break
    return bends


def _change(
    arms: Complexes, bent: Floats, miss: complex, is_low: Booleans, is_high: Booleans
) -> Floats:
    """Return a step of Newton's method for the smallest |bent|² whose end is moved by `miss`.

    `arms` are the ways from the joints to the end. Bends at an end of their range do not leave it.
    """
    free, tiny = np.arange(len(arms)), 1e-12 * (float(np.vdot(arms, arms).real) or 1.0) * np.eye(2)
    while True:
        own, here = arms[free], bent[free]
        # The end moves by i a for each bend of a joint, and two bends turn the arm of the later.
        rows = np.array([-own.imag, own.real])
        inverse = np.linalg.solve(rows @ rows.T + tiny, rows)
        step, force = miss.real * inverse[0] + miss.imag * inverse[1], inverse @ here
        if len(free) > 2:
            # Of bends that leave the end in place, the Hessian and the slope.
            order, one = np.arange(len(free)), np.eye(len(free))
            stays, later = one - rows.T @ inverse, own[np.maximum.outer(order, order)]
            second = one + force[0] * later.real + force[1] * later.imag
            values, vectors = np.linalg.eigh(stays @ second @ stays)
            slope = (stays @ (here + second @ step)) @ vectors
            step = step - vectors @ (slope / np.maximum(np.abs(values), LEAST_CURVATURE))
        leaves = (is_low[free] & (step < 0)) | (is_high[free] & (step > 0))
        if not leaves.any():
            break
        free = free[~leaves]
    change = np.zeros(len(arms))
    change[free] = step
    return change
