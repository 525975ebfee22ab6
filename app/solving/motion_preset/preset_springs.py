"""Springs of a motion preset: joints that follow others, such as the tip of a tail."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

from app.document import AppliedMotion, Layer, Spring, without_motion_springs
from app.rigging import FollowingJoint, find_spring_frequency

DAMPING = 0.35  # of springs: they overshoot a little


def make_springs(
    following: Iterable[FollowingJoint], joints: Mapping[str, int], seconds: float
) -> tuple[Spring, ...]:
    """Return the springs of joints that follow others, in a cycle of some seconds."""
    return tuple(
        Spring(
            handle=joints[each.joint],
            root=joints[each.root],
            frequency=find_spring_frequency(each.swings / seconds, each.delay, DAMPING),
            damping=DAMPING,
        )
        for each in following
    )


def with_springs(layer: Layer, given: AppliedMotion, edited: Collection[int] = ()) -> Layer:
    """Return a layer with the springs of a motion in place of those of motions that it replaces.

    Handles with a spring of their own, and those whose springs were `edited`, stay as they are.
    """
    for motion in layer.motions:
        if motion.overlaps(given.first, given.last):
            layer = without_motion_springs(layer, motion)
    taken = {spring.handle for spring in layer.springs}.union(edited)
    new = tuple(spring for spring in given.springs if spring.handle not in taken)
    return replace(layer, springs=(*layer.springs, *new))
