"""The joints of a layer, guessed from its shape and its picture."""

from collections.abc import Mapping
from typing import NamedTuple

from app.document import Layer
from app.rigging import (
    find_kind,
    guess_facing,
    guess_near_limbs,
    name_near_limbs,
    near_side,
    suggest_joints,
)
from engine.arrays import Bytes


class JointGuess(NamedTuple):
    """Joints of a kind of body by name, at rest.

    `unsure` are the ends of the near limbs of pairs of which either limb may be the near one.
    """

    joints: Mapping[str, complex]
    unsure: tuple[str, ...] = ()


def guess_joints(layer: Layer, kind: str, rgba: Bytes | None) -> JointGuess:
    """Return the joints of a kind of body in a layer; from the side, near limbs by the picture."""
    body, loops = find_kind(kind), layer.domain.loops
    joints = suggest_joints(loops, body)
    if rgba is None or not body.is_side_view or not joints:
        return JointGuess(joints)
    facing = guess_facing(body, joints, loops[0])
    found = guess_near_limbs(loops, joints, rgba, layer.corner)
    named = name_near_limbs(joints, found, facing)
    unsure = (limb.near.rpartition(".")[0] for limb in found if not limb.is_sure)
    ordered = {name: named[name] for name in body.parents if name in named}
    return JointGuess(ordered, tuple(f"{end}.{near_side(facing)}" for end in unsure))
