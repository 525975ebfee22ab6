"""Limits along a layer's outline: tighter where it is stiff, looser at the joints of bones."""

from collections.abc import Mapping

import numpy as np

from app.document.keyframe import Pose
from app.document.layer import FOLDING_JOINTS, Layer
from app.document.queries.material.boundary_stiffness import stiff_outline
from app.document.queries.memo import memoized_on
from app.document.rig.chains import Bone
from engine.arrays import Complexes, Floats
from engine.domain import MeshedDomain
from engine.domain.material.end_parts import find_end_part
from engine.domain.material.shafts import LimbShape, joint_share, measure_limb
from engine.errors import EngineError
from engine.geometry import next_on_loop
from engine.maps import Boundary, LocalBounds


def limb_shapes(layer: Layer) -> Mapping[Bone, LimbShape]:
    """Return the drawing around each bone that keeps its length.

    A bone that leaves the drawing, as after a change of the cut-out, is left out.
    """
    return limb_shapes_in(layer.domain, *bones_and_handles(layer))


def bones_and_handles(layer: Layer) -> tuple[tuple[Bone, ...], tuple[tuple[int, complex], ...]]:
    """Return the bones of a layer, and the ids and places of its handles: what limbs depend on."""
    return layer.bones, tuple((handle.id, handle.position) for handle in layer.handles)


@memoized_on
def limb_shapes_in(
    domain: MeshedDomain, bones: tuple[Bone, ...], handles: tuple[tuple[int, complex], ...]
) -> Mapping[Bone, LimbShape]:
    """Return the shapes of `limb_shapes` for bones in a domain."""
    places, found = dict(handles), {}
    loops, joints = domain.loops, {bone.ends[0] for bone in bones if bone.is_limb}
    for bone in bones:
        if bone.is_limb:
            start, end = (places[i] for i in bone.ends)
            try:
                shape = measure_limb(loops, start, end)
            except EngineError:
                continue
            if bone.ends[1] not in joints:
                others = [place for i, place in places.items() if i not in bone.ends]
                shape = shape._replace(end_part=find_end_part(loops, start, end, others))
            found[bone] = shape
    return found


def limits_along(layer: Layer, boundary: Boundary) -> LocalBounds:
    """Return the limits of new poses at the boundary's own samples."""
    limits = layer.bounds.scaled_by_stiffness(boundary)
    own, ends = boundary.original_samples
    shares = joint_shares(layer, boundary.points[own])
    if not shares.any():
        return limits
    # No segment beside a joint is held to the joint's limits.
    following = next_on_loop(np.array(ends[:-1]), len(own))
    before = np.empty_like(shares)
    before[following] = shares
    shares = np.minimum(shares, np.minimum(before, shares[following]))
    return limits.loosened(FOLDING_JOINTS, shares)


def joint_shares(layer: Layer, points: Complexes) -> Floats:
    """Return how much points of the outline belong to joints of bones, from 0 to 1."""
    shares = np.zeros(len(points))
    for bone, shape in limb_shapes(layer).items():
        start, end = (layer.handle(identity).position for identity in bone.ends)
        bending = shape.bending_shares(has_joint=bone.ends[1] in layer.bone_joints)
        for share in shape.root_shares + bending:
            place = start + share * (end - start)
            shares = np.maximum(shares, joint_share(points, place, shape.joint_width))
    return shares


def uses_local_limits(layer: Layer, pose: Pose, share: float) -> bool:
    """Return whether a pose uses more than a share of the limits anywhere along the outline."""
    points, stiffness = stiff_outline(layer)
    limits = layer.bounds.scaled_by(np.maximum(stiffness, 1.0))
    limits = limits.loosened(FOLDING_JOINTS, joint_shares(layer, points))
    f, g = layer.map_of(pose).derivatives(points)
    a, b = np.abs(f), np.abs(g)
    # A folded map counts too: its logarithms are infinite or NaN.
    with np.errstate(all="ignore"):
        spent = [
            b / a / limits.k,
            np.log(a + b) / np.log(limits.sigma_a),
            np.log(a - b) / np.log(limits.sigma_b),
        ]
    return not bool(np.max(spent) <= share)
