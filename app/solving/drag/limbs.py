"""Limbs of a layer: its chains of bones as shafts and hinges for the deformer.

The body is one more shaft, of the shape at the start of a drag: what lies beyond all limbs, held
together as long as the drag moves it only as a whole. Roots of chains are hinged to it, or to the
end of the chain at which they start.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.document import Limbs
from engine.deform import Aim, Armature, Hinge, Shaft
from engine.maps import Boundary, HarmonicMap

# κ L² of each point of the body.
BODY_STIFFNESS = 1e2
# Largest force, per L, with which joints are pulled to the places of kinematics.
JOINT_FORCE = 50.0
# The same of dragged ends, which kinematics keeps within reach. An arm that has to bend inside a
# broad trunk needs more than joints do.
END_FORCE = 200.0


@dataclass(frozen=True, kw_only=True, eq=False)
class PosedLimbs:
    """The limbs as they are in the pose at which a drag starts.

    `joints` are the places of the handles of all chains, by id.
    """

    limbs: Limbs
    joints: Mapping[int, complex]
    armature: Armature
    has_body: bool

    @classmethod
    def at(
        cls, limbs: Limbs, boundary: Boundary, shape: HarmonicMap, *, has_body: bool
    ) -> "PosedLimbs":
        """Return the limbs in the pose of a map."""
        joints = locate_joints(limbs, boundary, shape)
        has_body = has_body and len(limbs.body) > 1
        armature = limbs.bones_in(boundary)
        if has_body:
            body, number = (
                Shaft(limbs.body, shape(limbs.body), BODY_STIFFNESS),
                len(limbs.bone_shafts),
            )
            hinges = [
                Hinge(number, limb.first_shaft, joints[limb.chain.root], limb.places[0])
                for limb in limbs.limbs
                if limb.parent is None
            ]
            armature = Armature.place(
                boundary, [*limbs.bone_shafts, body], [*limbs.bone_hinges, *hinges]
            )
        return cls(limbs=limbs, joints=joints, armature=armature, has_body=has_body)

    def aims(self, joints: Mapping[int, complex]) -> list[Aim]:
        """Return the aims of roots and joints at their places; ends are handles of their own."""
        aims, held = [], {limb.chain.root for limb in self.limbs.limbs}
        for limb in self.limbs.limbs:
            root, *inner, end = limb.chain.handles
            if limb.parent is None:
                body = len(self.limbs.bone_shafts)
                start = (
                    (body, self.joints[root])
                    if self.has_body
                    else (limb.first_shaft, limb.places[0])
                )
                aims.append(Aim(*start, joints[root]))
            for number, joint in enumerate(inner):
                place = limb.places[number + 1]
                aims.append(Aim(limb.first_shaft + number, place, joints[joint], JOINT_FORCE))
            if end in held:
                aims.append(Aim(limb.first_shaft + len(inner), limb.places[-1], joints[end]))
        return aims


def locate_joints(limbs: Limbs, boundary: Boundary, shape: HarmonicMap) -> dict[int, complex]:
    """Return the places of the handles of all chains in a pose, by id.

    A joint lies in the middle between the places to which its bones carry it.
    """
    armature = limbs.bones_in(boundary)
    phi, psi = shape.columns
    positions = armature.coordinates @ phi + (armature.coordinates @ psi).conj()
    motions, found = armature.motions(positions), dict[int, list[complex]]()
    for limb in limbs.limbs:
        for number, ((start, end), ids) in enumerate(
            zip(
                limb.bones,
                zip(limb.chain.handles, limb.chain.handles[1:], strict=False),
                strict=True,
            )
        ):
            shafts = np.full(2, limb.first_shaft + number)
            carried = armature.carried(motions, shafts, np.array([start, end]))
            for identity, place in zip(ids, carried.tolist(), strict=True):
                found.setdefault(identity, []).append(place)
    return {identity: complex(np.mean(places)) for identity, places in found.items()}
