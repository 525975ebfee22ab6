"""The map that is nearest to a displayed frame, and to given derivatives."""

import numpy as np

from app.document import (
    Clip,
    Pose,
    Target,
    keyed_pose_at,
    segment_keys,
    segment_time_at,
    slider_weights_at,
)
from app.motion import Animation, PoseSampler
from app.solving.drag.rig import Rig
from engine.arrays import Booleans, Complexes
from engine.maps import Boundary, HarmonicMap, certify


def fit_shown_pose(
    rig: Rig,
    clip: Clip,
    frame: float,
    sibling: PoseSampler | None = None,
    *,
    with_sliders: bool = False,
) -> Pose:
    """Return a single map that is nearest to a frame, by default without sliders, as a pose.

    At a key it is the key's own pose. In-betweens are no maps over the cage, so their derivatives
    are fitted on the outline. A fit without certificate is mixed with the nearer key. A sibling of
    the layer's domain is reused for its data of the outline.
    """
    layer, boundary = rig.layer, rig.deformer.boundary
    moment = segment_time_at(clip, frame)
    resting = keyed_pose_at(clip, moment)
    if resting is not None and not (with_sliders and any(slider_weights_at(clip, frame))):
        return resting
    after = moment.weight > 0.5
    near = resting or clip.keys[segment_keys(clip)[moment.segment][after]].pose
    sampler = PoseSampler(layer, points=boundary.points, sibling=sibling)
    animation = Animation(clip, points=boundary.points, sampler=sampler)
    base = animation.base
    found, time = base.segment_at(frame) if with_sliders else base.unslid_at(frame)
    blended = found.frame(time)
    fitted = fit_map(boundary, blended.fz, blended.fzbar, blended.positions)
    for share in (1.0, 0.5, 0.25, 0.0):
        own = layer.map_of(near)
        mixed = own.changed(
            *(share * (new - old) for new, old in zip(fitted.columns, own.columns, strict=True))
        )
        # The displayed frame may be older than the current stiffness.
        certificate = certify(mixed, boundary, rig.deformer.bounds)
        # A frame with sliders may lie on the limits, and its fit a little beyond.
        is_unfolded = certificate.winding == 0 and certificate.k < 1 and certificate.sigma_b > 0
        if certificate.is_certified or (with_sliders and is_unfolded):
            break
    else:
        mixed, certificate = layer.map_of(near), near.certificate
    places = mixed(np.array([handle.position for handle in layer.handles], dtype=np.complex128))
    targets = {
        handle.id: Target(position=complex(place))
        for handle, place in zip(layer.handles, places, strict=True)
    }
    return rig.posed_at(mixed, targets).make_pose(mixed, targets, certificate)


def fit_map(
    boundary: Boundary,
    fz: Complexes,
    fzbar: Complexes,
    positions: Complexes,
    *,
    inside: Booleans | None = None,
) -> HarmonicMap:
    """Return the map over a cage whose derivatives on the outline are nearest to the given ones.

    `fz`, `fzbar` and `positions`, complex128 (s,), are those of the other map at the boundary's
    samples, or at the samples chosen by `inside`, bool (m,).
    """
    chosen = slice(None) if inside is None else inside
    weights = boundary.lengths[chosen]
    root = np.sqrt(weights)[:, None]
    # Constants have no derivative; the positions on the outline determine them.
    matrix = root * boundary.derivatives[chosen, 1:]
    wanted = root * np.column_stack([fz, fzbar.conj()])
    solved, *_ = np.linalg.lstsq(matrix, wanted, rcond=None)
    count = len(boundary.holes)
    logs: Complexes = np.empty(0, dtype=np.complex128)
    if count:
        # The logarithms of Ψ are conjugates of those of Φ. With their mean, the rest is fitted once
        # more.
        logs = np.asarray(solved[-count:, 0] + solved[-count:, 1].conj(), np.complex128) / 2
        wanted = wanted - matrix[:, -count:] @ np.column_stack([logs, logs.conj()])
        solved, *_ = np.linalg.lstsq(matrix[:, :-count], wanted, rcond=None)
    phi, psi = (np.concatenate([[0], column]) for column in solved.T)
    shape = HarmonicMap(cage=boundary.cage, phi=phi, psi=psi, holes=boundary.holes, logs=logs)
    offset = weights @ (positions - shape(boundary.points[chosen])) / weights.sum()
    return shape.moved(1.0, complex(offset))
