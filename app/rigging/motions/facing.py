"""Guess the facing of a drawing from its joints and its outline."""

from collections.abc import Mapping

import numpy as np

from app.rigging.motions.body import other_side
from app.rigging.motions.kinds import BodyKind
from engine.arrays import Complexes, as_points

# Weights of the signs for a kind seen from the side. Heads are ahead of hips, tails behind; knees
# bend ahead; toes and noses are ahead of the joints in feet and heads.
AROUND = 0.12  # of the height: radius around a joint in which the outline counts


def guess_facing(kind: BodyKind, joints: Mapping[str, complex], outline: Complexes) -> int:
    """Return 1 for a drawing that faces right, -1 for left.

    Parameters
    ----------
    joints : mapping of str to complex
        Places at rest, y up.
    outline : complex128, shape (n,)
        Of the drawing.
    """
    outline = as_points(outline, "outline", at_least=3)
    as_points(list(joints.values()), "The joints of a body")
    if kind.name == "chain" and len(joints) > 1:
        # The first joint is in front.
        places = [joints[name] for name in kind.parents if name in joints]
        return 1 if places[0].real > places[-1].real else -1
    if kind.name == "biped-front":
        # For these kinds names decide: ahead is where the left side is.
        sides = [
            (at - joints[other_side(name)]).real
            for name, at in joints.items()
            if name.endswith(".L") and other_side(name) in joints
        ]
        return 1 if sum(sides) >= 0 else -1
    if kind.name not in {"biped-side", "four-legs"}:
        return 1
    ways = [
        *(3 * way for way in _between(joints, "hips", "head")),
        *(2 * way for way in _between(joints, "hips", "chest") if kind.name == "four-legs"),
        *_between(joints, "tail", "hips"),
        6 * _beyond(outline, [joints[name] for name in ("foot.L", "foot.R") if name in joints]),
        2 * _beyond(outline, [joints[name] for name in ("head",) if name in joints]),
    ]
    if kind.name == "biped-side":
        ways += [2 * way for side in "LR" for way in _bent(joints, side)]
    return 1 if sum(ways) >= 0 else -1


def _between(joints: Mapping[str, complex], behind: str, ahead: str) -> list[float]:
    """Return how far one joint is ahead of another, if both exist."""
    if behind in joints and ahead in joints:
        return [(joints[ahead] - joints[behind]).real]
    return []


def _bent(joints: Mapping[str, complex], side: str) -> list[float]:
    """Return how far a knee is ahead of the middle of its leg."""
    root = joints.get(f"hip.{side}", joints.get("hips"))
    knee, foot = joints.get(f"knee.{side}"), joints.get(f"foot.{side}")
    if root is None or knee is None or foot is None or root == foot:
        return []
    share = ((knee - root) / (foot - root)).real
    return [(knee - root - share * (foot - root)).real]


def _beyond(outline: Complexes, joints: list[complex]) -> float:
    """Return how much farther the outline around joints reaches to the right than to the left."""
    near = AROUND * float(np.ptp(outline.imag))
    beside = [outline[np.abs(outline.imag - joint.imag) < near / 2].real for joint in joints]
    beside = [
        places[np.abs(places - joint.real) < 2 * near]
        for places, joint in zip(beside, joints, strict=True)
    ]
    around = np.concatenate([np.zeros(0), *beside])
    if not len(around):
        return 0.0
    ends = [joint.real for joint in joints]
    return float((around.max() - max(ends)) - (min(ends) - around.min()))
