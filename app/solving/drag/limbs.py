"""Limbs of a layer: its chains of bones as shafts and hinges for the deformer.

The body is one more shaft, of the shape at the start of a drag: what lies beyond all limbs, held
together as long as the drag moves it only as a whole. Roots of chains are hinged to it, or to the
end of the chain at which they start.
"""

import cmath
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from math import inf

import numpy as np

from app.document import Limbs, PlacedLimbs
from engine.deform import Aim, Armature, Hinge, Shaft
from engine.maps import Boundary, HarmonicMap

# κ L² of each point of the body.
BODY_STIFFNESS = 2e4
# Largest force, per L, with which joints are pulled to the places of kinematics.
JOINT_FORCE = 500.0
# The same of dragged ends, which kinematics keeps within reach. An arm that has to bend inside a
# broad trunk needs more than joints do.
END_FORCE = 3000.0
# Factor of the weights of the body's handles and of roots: the limbs bend, not the body.
BODY_FIRMNESS = 2.0
# Weight of rigid ends. Around other ends the bone's stiffness makes their handles firmer.
END_WEIGHT = 80.0
# Largest force, per L, with which rigid ends are turned to their angles, at this lever over L.
ANGLE_FORCE, ANGLE_LEVER = 50.0, 0.2


@dataclass(frozen=True, kw_only=True, eq=False)
class PosedLimbs:
    """The limbs with their armature, and where they are in the pose at which a drag starts."""

    limbs: Limbs
    start: PlacedLimbs
    armature: Armature
    has_body: bool

    @classmethod
    def at(
        cls, limbs: Limbs, boundary: Boundary, shape: HarmonicMap, *, has_body: bool
    ) -> "PosedLimbs":
        """Return the limbs in the pose of a map."""
        armature = limbs.armature_in(boundary)
        start = _locate(limbs, armature, shape)
        if has_body:
            points, number = np.concatenate([limbs.body, limbs.beside_roots]), len(limbs.shafts)
            weights = np.concatenate([np.ones(len(limbs.body)), limbs.shares_beside])
            body = Shaft(points, shape(points), BODY_STIFFNESS, weights)
            hinges = [
                Hinge(number, limb.first_shaft, start.places[limb.chain.root], limb.places[0])
                for limb in limbs.limbs
                if limb.parent is None
            ]
            hinges = [*limbs.hinges, *hinges]
            shafts = [*limbs.shafts, body, *limbs.widths]
            armature = Armature.place(boundary, shafts, hinges, limbs.ties)
        return cls(limbs=limbs, start=start, armature=armature, has_body=has_body)

    def locate(self, shape: HarmonicMap) -> PlacedLimbs:
        """Return where a map carries the handles of all chains."""
        return _locate(self.limbs, self.armature, shape)

    def aims(
        self,
        joints: Mapping[int, complex],
        angles: Mapping[int, float],
        *,
        pulled: Collection[int] = (),
        free: Collection[int] = (),
        holds_body: bool = False,
    ) -> list[Aim]:
        """Return the aims of roots and joints at their places, and of rigid ends.

        Other ends are handles of their own. Ends that are `pulled` have a bounded force, and `free`
        ones have none. With `holds_body` the body keeps its rotation.
        """
        aims, held = [], {limb.chain.root for limb in self.limbs.limbs}
        if holds_body and self.has_body:
            lever = complex(ANGLE_LEVER * self.armature.size)
            aims.append(Aim(len(self.limbs.shafts), lever, lever, is_way=True))
        for limb in self.limbs.limbs:
            root, *inner, end = limb.chain.handles
            if limb.parent is None:
                body = len(self.limbs.shafts)
                start = (
                    (body, self.start.places[root])
                    if self.has_body
                    else (limb.first_shaft, limb.places[0])
                )
                aims.append(Aim(*start, joints[root], weight=BODY_FIRMNESS))
            for number, joint in enumerate(inner):
                place = limb.places[number + 1]
                aims.append(Aim(limb.first_shaft + number, place, joints[joint], JOINT_FORCE))
            if limb.end_shaft is not None and end not in free:
                force = END_WEIGHT * END_FORCE if end in pulled else inf
                place = limb.places[-1]
                aims.append(Aim(limb.end_shaft, place, joints[end], force, END_WEIGHT))
                lever = ANGLE_LEVER * self.armature.size
                way = lever * cmath.exp(1j * angles[end])
                aims.append(Aim(limb.end_shaft, lever, way, ANGLE_FORCE, is_way=True))
            if end in held and limb.end_shaft is None:
                aims.append(Aim(limb.first_shaft + len(inner), limb.places[-1], joints[end]))
        return aims


def _locate(limbs: Limbs, armature: Armature, shape: HarmonicMap) -> PlacedLimbs:
    """Return where a map carries limbs, with whose shafts the armature begins."""
    phi, psi = shape.columns
    coordinates = armature.coordinates[: len(limbs.points)]
    return limbs.locate(coordinates @ phi + (coordinates @ psi).conj())
