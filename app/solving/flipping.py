"""Flipped poses: what the left side does, the right side does, and the other way round."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from app.document import Figure, Pose, Target, partners_of
from app.solving.drag import Rig, fit_map, pins_of
from engine.arrays import Complexes
from engine.geometry import contains
from engine.maps import HarmonicMap, certify

MOST_STEPS = 600  # for one pose
# Of a shape that counts as symmetric, the part at least that lies on its own mirror image.
SYMMETRIC = 0.9


def flip_poses(rig: Rig, poses: Sequence[Pose], axis: float) -> list[Pose]:
    """Return poses of a rig's figure mirrored at an upright axis, solved within its bounds.

    The axis is told in pixels from the left.
    """
    return [_flip(rig, pose, axis) for pose in poses]


def flipped_targets(figure: Figure, pose: Pose, axis: float) -> Mapping[int, Target]:
    """Return where a flipped pose wants each handle.

    A flipped pose would be R ∘ f ∘ R, with R(z) = 2a − conj(z) the reflection, were the drawing its
    own mirror image. It hardly ever is: R takes a handle h to a place beside its partner p. What
    the pose does at p it does, mirrored, to R(p), and it takes h along as a rigid body would:

        R(f(p)) + u (h − R(p)),  u = conj(f_z(p) / |f_z(p)|)

    So the drawing at rest stays at rest whatever its pairs are, a shape that is turned as a whole
    is turned the other way, and flipping twice changes nothing.

    Partners are told by the names of handles, then by their places; on a symmetric shape a handle
    without either does what the shape does at its mirror image, and else it mirrors itself.
    """
    shape = figure.map_of(pose)
    handles = {handle.id: handle for handle in figure.handles}
    partners = partners_of(figure.handles, axis, figure.domain.outline)
    is_symmetric = _is_symmetric(figure, axis)
    targets = {}
    for handle in figure.handles:
        partner = handles.get(partners.get(handle.id, -1))
        place, target = handle.position, pose.targets[handle.id]
        if partner is not None:
            place, target = partner.position, pose.targets[partner.id]
        elif is_symmetric and figure.covers(np.array([_reflect(place, axis)]))[0]:
            place = _reflect(place, axis)
            target = replace(target, position=complex(shape(np.array([place]))[0]), rotation=None)
        position = _flipped(shape, axis, place, target.position, handle.position)
        targets[handle.id] = replace(
            pose.targets[handle.id],
            position=position,
            rotation=None if target.rotation is None else -target.rotation,
        )
    return targets


def _flipped(
    shape: HarmonicMap, axis: float, place: complex, wished: complex, point: complex
) -> complex:
    """Return where a point goes if it moves as the mirror image of a place with a target."""
    (fz,), _ = shape.derivatives(np.array([place]))
    turned = complex(np.conj(fz) / abs(fz))
    return _reflect(wished, axis) + turned * (point - _reflect(place, axis))


def _flip(rig: Rig, pose: Pose, axis: float) -> Pose:
    deformer = rig.deformer
    targets = flipped_targets(rig.figure, pose, axis)
    shape = rig.figure.map_of(pose)
    pins = tuple(
        Target(position=_flipped(shape, axis, joint, pin.position, joint))
        for joint, pin in zip(rig.pins, pins_of(rig.figure, pose), strict=True)
    )
    state = deformer.start()
    if _is_symmetric(rig.figure, axis):
        state = rig.beginning_at(_flipped_map(rig, pose, axis))
    state, _ = deformer.settle(state, rig.wish(targets, pins), at_most=MOST_STEPS)
    # Steps that walk into the bounds are proven for wider ones.
    proven = certify(state.map, deformer.boundary, deformer.bounds)
    return rig.pose(state.map, targets, proven)


def _flipped_map(rig: Rig, pose: Pose, axis: float) -> HarmonicMap:
    """Return the map that is nearest to R ∘ f ∘ R, with which the solver begins."""
    figure, boundary = rig.figure, rig.deformer.boundary
    mirrored = _reflected(boundary.points, axis)
    cage, *inner = figure.domain.cages
    inside = contains(cage, mirrored, holes=inner)
    shape, points = figure.map_of(pose), mirrored[inside]
    fz, fzbar = shape.derivatives(points)
    places = _reflected(shape(points), axis)
    # (R ∘ f ∘ R)_z = conj(f_z) at R(z), and likewise for z̄.
    return fit_map(boundary, fz.conj(), fzbar.conj(), places, inside=inside)


def _is_symmetric(figure: Figure, axis: float) -> bool:
    mirrored = _reflected(figure.domain.mesh.vertices, axis)
    return bool(figure.covers(mirrored).mean() >= SYMMETRIC)


def _reflected(points: Complexes, axis: float) -> Complexes:
    return 2 * axis - points.conj()


def _reflect(place: complex, axis: float) -> complex:
    return 2 * axis - place.conjugate()
