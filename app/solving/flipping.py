"""Flipped poses: the left and the right side exchanged."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from app.document import PAIRS, Layer, Pose, SidePairs, Target, mirrored_handles
from app.solving.drag.rig import Rig, pins_of
from app.solving.pose_transfer import (
    SimilarityTransform,
    find_initial_map,
    is_similar,
    joint_sides,
    solve_from_map,
    transferred_side,
)


def flip_poses(
    rig: Rig, poses: Sequence[Pose], axis: float, pairs: SidePairs = PAIRS
) -> list[Pose]:
    """Return poses mirrored at a vertical axis, in pixels, solved within the limits."""
    return [_flip(rig, pose, axis, pairs) for pose in poses]


def flip_targets(
    layer: Layer, pose: Pose, axis: float, pairs: SidePairs = PAIRS
) -> Mapping[int, Target]:
    """Return the target of each handle in a flipped pose.

    With R(z) = 2a − conj(z) the reflection, the flipped pose of a symmetric drawing is R ∘ f ∘ R.
    Drawings are rarely symmetric: R maps a handle to a place near its partner.
    `SimilarityTransform.transform_target` corrects for the offset.

    Partners are found by name, then by position. On a symmetric shape, a handle without a partner
    takes the motion of the shape at its mirror image. Otherwise it mirrors its own motion.
    """
    shape, similarity = layer.map_of(pose), SimilarityTransform.reflection(axis)
    handles = {handle.id: handle for handle in layer.handles}
    partners = mirrored_handles(layer.handles, axis, layer.domain.outline, pairs)
    is_symmetric = is_similar(layer, layer, similarity)
    targets, sides = {}, joint_sides(layer, pose)
    for handle in layer.handles:
        partner = handles.get(partners.get(handle.id, -1))
        place, target = handle.position, pose.targets[handle.id]
        mirrored = similarity.apply_to_point(place)
        if partner is not None:
            place, target = partner.position, pose.targets[partner.id]
        elif is_symmetric and layer.covers(np.array([mirrored]))[0]:
            place = mirrored
            target = replace(target, position=complex(shape(np.array([place]))[0]), rotation=None)
        targets[handle.id] = replace(
            pose.targets[handle.id],
            position=similarity.transform_target(shape, place, target.position, handle.position),
            rotation=None if target.rotation is None else -target.rotation,
            side=transferred_side(
                sides.get(handle.id if partner is None else partner.id), mirrors=True
            ),
        )
    return targets


def _flip(rig: Rig, pose: Pose, axis: float, pairs: SidePairs) -> Pose:
    similarity = SimilarityTransform.reflection(axis)
    targets = flip_targets(rig.layer, pose, axis, pairs)
    shape = rig.layer.map_of(pose)
    pins = [
        Target(position=similarity.transform_target(shape, joint, pin.position, joint))
        for joint, pin in zip(rig.pins, pins_of(rig.layer, pose), strict=True)
    ]
    begin, ways = find_initial_map(rig, rig.layer, pose, similarity, targets)
    return solve_from_map(rig, begin, targets, pins, ways)
