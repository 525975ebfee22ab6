"""What kind of body a shape looks like."""

from collections.abc import Sequence

import numpy as np

from engine.arrays import Complexes
from engine.domain.limbs.body_plan import FOOT, TOES, BodyPlan
from engine.domain.limbs.chain import is_chain
from engine.geometry import contains
from engine.geometry.motions import BodyKind, kind_named

# From the front it is so much of a shape that its mirror image covers.
SYMMETRIC = 0.82
SAMPLES = 48  # of the shape's box, along each side
MOST_LEGS, MOST_LIMBS = 4, 9


def guessed_kind(loops: Sequence[Complexes]) -> BodyKind:
    """Return the kind of body that a shape looks like.

    Parameters
    ----------
    loops : sequence of complex128
        The outline, counter-clockwise, and the outlines of the holes; y up.

    Returns
    -------
    BodyKind
        Of the drawing as it is: legs stand on the ground, a chain is all along one path; what
        is neither is anything.
    """
    return _kind(BodyPlan(loops))


def _kind(plan: BodyPlan) -> BodyKind:
    """Return what kind of body it is."""
    count = len(plan.legs)
    if count > MOST_LEGS or len(plan.anatomy.branches) > MOST_LIMBS:
        return kind_named("anything")
    if plan.lies:
        return kind_named("four-legs")
    if count > 1:
        return kind_named("biped-front" if _is_frontal(plan) else "biped-side")
    is_long = is_chain(plan)
    # What is low at a fish is a fin.
    if count == 1 and abs(plan.toes[0]) > FOOT and not (is_long and plan.wide > plan.tall):
        return kind_named("biped-side")
    return kind_named("chain" if is_long else "anything")


def _is_frontal(plan: BodyPlan) -> bool:
    """Tell whether a body on two legs is seen from the front, by its toes or its symmetry."""
    toes = plan.toes[0], plan.toes[-1]
    if min(map(abs, toes)) > TOES:
        return toes[0] * toes[1] < 0
    return _symmetry(plan) >= SYMMETRIC


def _symmetry(plan: BodyPlan) -> float:
    """Return which part of the shape is covered by its mirror image, at the hips' middle."""
    steps = (np.arange(SAMPLES) + 0.5) / SAMPLES
    grid = plan.low + steps * plan.wide + 1j * steps[:, None] * plan.tall
    inside = grid[contains(plan.loops[0], grid.ravel()).reshape(grid.shape)]
    middle = plan.places[plan.hips].real
    return float(contains(plan.loops[0], 2 * middle - inside.conj()).mean())
