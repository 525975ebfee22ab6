"""Bones of a layer during a segment."""

import numpy as np

from app.document import Keyframe, Layer, Limbs
from engine.arrays import Booleans, Complexes, Floats
from engine.interpolation import ChainOfBones, SegmentBones, TimeWeights

BODY_POINTS = 8  # of those that tell how the body moves
END_POINTS = 8  # of those that hold a foot, a hand or a head
# Firmness of a pinned joint, whose target is a point of the drawing. Bones are as firm.
JOINT_FIRMNESS = 0.5


def rigid_points(limbs: Limbs) -> list[Complexes]:
    """Return the points of the body, of each bone, and of each rigid part at an end.

    Without a body they begin with those of the first bone.
    """
    shafts = [shaft.points[:END_POINTS] for shaft in limbs.shafts]
    body = limbs.body[:BODY_POINTS]
    return [body if len(body) > 1 else shafts[0], *shafts]


def segment_bones(
    layer: Layer,
    limbs: Limbs,
    keys: tuple[Keyframe, Keyframe],
    places: Complexes,
    revolutions: tuple[int, ...],
    time_weights: TimeWeights,
) -> SegmentBones:
    """Return the bones of a segment.

    `places`, (q, p), are those of the rigid points at all keys with a time weight, and
    `revolutions` the whole turns between these keys.
    """
    numbers = {handle.id: number for number, handle in enumerate(layer.handles)}
    chains = [
        ChainOfBones(
            parent=0 if limb.parent is None else limb.parent + 1,
            parts=tuple(limb.first_shaft + 1 + i for i in range(len(limb.lengths))),
            joints=limb.places,
            end=numbers[limb.chain.end],
            end_part=None if limb.end_shaft is None else limb.end_shaft + 1,
            has_own_angle=all(
                key.pose.targets[limb.chain.end].rotation is not None for key in keys
            ),
        )
        for limb in limbs.limbs
    ]
    return SegmentBones(
        rest=rigid_points(limbs),
        places=places,
        chains=chains,
        revolutions=revolutions,
        time_weights=time_weights,
    )


def firmness_on_limbs(layer: Layer, limbs: Limbs, firmness: Floats, is_pinned: Booleans) -> Floats:
    """Return the firmness of handles: those of limbs follow their bones unless they are pinned.

    Rigid ends hold their own points.
    """
    on_limbs = {identity for limb in limbs.limbs for identity in limb.chain.handles}
    changed = firmness.copy()
    for number, handle in enumerate(layer.handles):
        if handle.id in on_limbs:
            held = JOINT_FIRMNESS if handle.id in layer.bone_joints else 1.0
            if handle.id in limbs.rigid_ends or not is_pinned[number]:
                held = 0.0
            changed[number] *= held
    return np.asarray(changed, np.float64)
