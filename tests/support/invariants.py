"""What holds of a session whatever a person did; asked after every gesture of a test."""

from functools import lru_cache

import numpy as np

from app.document import TRANSFORM, Transform, layer_value_at
from app.document.keyframe import Pose
from app.document.layer import Layer
from app.document.queries.channel_values.channel_keys import frames_in
from app.editor.actions import playback
from app.editor.project import Project
from app.editor.session import Session
from engine.domain.build import MeshedDomain
from engine.domain.validity import require_domain
from engine.maps.boundary import Boundary
from engine.maps.bounds import Bounds
from engine.maps.certificate import Certificate, certify
from engine.maps.harmonic_map import HarmonicMap

OPEN = 0.05  # of the larger layer: the gap at a joint that coarse triangles may leave
SLACK = 1e-6  # of a certificate's numbers, by which rounding may differ


def check_invariants(session: Session) -> None:
    """Fail where the document, or how it is looked at, contradicts itself."""
    project = session.project
    if project is None:
        return
    document, layer = project.document, project.layer
    assert set(project.runtimes.layers) == {each.id for each in document.layers}
    assert project.selection.handles <= {handle.id for handle in layer.handles}
    for channel, frames in project.selection.keys.items():
        assert frames
        assert frames <= frames_in(document, channel)
    assert playback.current_frame(session, project) in document.frames
    for each in document.layers:
        frames = [key.frame for key in each.keys]
        assert frames
        assert frames == sorted(set(frames))
        assert all(frame in document.frames for frame in frames)
        for key in each.keys:
            check_pose(each, key.pose)
    check_joints(project)
    if project.unkeyed_pose is not None:
        check_pose(layer, project.unkeyed_pose)


def check_joints(project: Project) -> None:
    """Fail where a layer is not drawn at its joint with its parent."""
    for layer in project.document.layers:
        child, joint = (
            project.runtimes.layers[layer.id].shown,
            project.document.attachment_at(layer, 0),
        )
        if (
            joint is None
            or joint.parent is None
            or joint.keep_world_transform
            or len(layer.attachments) > 1
        ):
            continue
        parent = project.runtimes.layers[joint.parent].shown
        if child is None or parent is None:
            continue
        pair = (child, layer), (parent, project.document.layer(joint.parent))
        if not all(each.is_current and each.clip.layer is now for each, now in pair):
            continue
        anchor = child.placement.apply(np.array([child.pivot_frame_at(layer.anchor).position]))[0]
        at = parent.placement.apply(np.array([parent.pivot_frame_at(joint.parent_point).position]))[
            0
        ]
        # Both are drawn by triangles of their own.
        size = max(abs(now.domain.outline - now.domain.outline.mean()).max() for _, now in pair)
        factor = (
            parent.placement.factor * parent.pivot_frame_at(joint.parent_point).rotation
            if joint.inherits_rotation
            else 1.0
        )
        away = joint.offset
        if joint.applies_transform:
            # A transform of the layer's own moves it off its joint, along the layer's axes.
            frame = project.document.loop_frame(child.frame)
            own = layer_value_at(project.document, layer, TRANSFORM, frame) or Transform()
            at_rest = joint.inherits_rotation
            held = np.exp(-1j * joint.rest_rotation) / joint.rest_scale if at_rest else 1.0
            away += held * own.shift
        gap = abs(anchor - at - factor * away)
        assert gap < OPEN * size, f"{layer.name} is {gap} from its joint {joint}: {child}, {parent}"


def check_pose(layer: Layer, pose: Pose) -> None:
    """Fail unless a pose is of a layer, and its certificate is true."""
    assert set(pose.targets) == {handle.id for handle in layer.handles}
    assert len(pose.phi) == len(pose.psi) == sum(map(len, layer.domain.cages))
    assert len(pose.logs) == len(layer.domain.holes)
    assert np.isfinite(pose.phi).all()
    assert np.isfinite(pose.psi).all()
    if pose.certificate.is_certified:
        assert _is_true(layer.domain, pose)


@lru_cache(maxsize=512)
def _is_true(domain: MeshedDomain, pose: Pose) -> bool:
    told: Certificate = pose.certificate
    allowed = Bounds(
        k=told.k + SLACK,
        sigma_a=max(told.sigma_a, 1.0) + SLACK,
        sigma_b=min(told.sigma_b, 1.0) - SLACK,
    )
    shape = HarmonicMap(
        cage=domain.cage, phi=pose.phi, psi=pose.psi, holes=domain.holes, logs=pose.logs
    )
    return certify(shape, _boundary(domain), allowed).is_certified


@lru_cache(maxsize=8)
def _boundary(domain: MeshedDomain) -> Boundary:
    require_domain(domain)
    return Boundary.sample(domain)
