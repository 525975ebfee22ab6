"""Guess of the kind of body."""

from collections.abc import Sequence

from app.rigging.anatomy.body_plan import FOOT, SYMMETRIC, TOES, BodyPlan
from app.rigging.anatomy.chain import is_chain
from app.rigging.anatomy.legs import TrackedLeg, are_beside
from app.rigging.motions.kinds import BodyKind, find_kind
from engine.arrays import Complexes

MOST_LEGS, MOST_LIMBS = 4, 9


def guess_kind(loops: Sequence[Complexes], legs: Sequence[TrackedLeg] = ()) -> BodyKind:
    """Return the kind of body that a drawing looks like.

    `loops` are the outline, counter-clockwise, and the outlines of the holes; y up. `legs` are
    those that lines part. The drawing is judged as it stands: legs are on the ground, a chain lies
    along one path; other shapes are without joints.
    """
    kind = _kind(BodyPlan(loops, legs))
    # By its silhouette, a body on two legs beside each other is long, or like anything.
    is_parted = kind.name in ("chain", "anything") and len(legs) == 2 and are_beside(*legs)
    return find_kind("biped-side") if is_parted else kind


def _kind(plan: BodyPlan) -> BodyKind:
    count = len(plan.legs)
    if count > MOST_LEGS or len(plan.anatomy.branches) > MOST_LIMBS:
        return find_kind("anything")
    if plan.is_lying:
        return find_kind("four-legs")
    if count > 1:
        return find_kind("biped-front" if _is_frontal(plan) else "biped-side")
    if plan.has_half_a_pair and plan.is_upright:
        return find_kind("biped-front")
    is_long = is_chain(plan)
    # The low part of a fish is a fin.
    stands = count == 1 and abs(plan.toes[0]) > FOOT and plan.is_upright
    if stands and not (is_long and plan.wide > plan.tall):
        return find_kind("biped-side")
    return find_kind("chain" if is_long else "anything")


def _is_frontal(plan: BodyPlan) -> bool:
    """Whether a body on two legs is seen from the front, by its toes or its symmetry."""
    left, right = plan.toes[0], plan.toes[-1]
    if abs(left + right) > 2 * TOES:
        return False
    return -left > TOES < right or plan.symmetry >= SYMMETRIC
