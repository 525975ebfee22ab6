"""What holds of a session whatever a person did; asked after every gesture of a test."""

from functools import lru_cache

import numpy as np

from app.document.figure import Figure
from app.document.keyframe import Pose
from app.editor.actions import playback
from app.editor.project import Project
from app.editor.session import Session
from app.editor.timeline_view import frames_in
from engine.domain.build import Domain
from engine.domain.validity import require_domain
from engine.maps.boundary import Boundary
from engine.maps.bounds import Bounds
from engine.maps.certificate import Certificate, certify
from engine.maps.harmonic_map import HarmonicMap

OPEN = 0.05  # of a layer: what a joint is open, as coarse triangles have it
SLACK = 1e-6  # of a certificate's numbers, by which rounding may differ


def check_invariants(session: Session) -> None:
    """Fail where the document, or how it is looked at, contradicts itself."""
    project = session.project
    if project is None:
        return
    document, figure = project.document, project.figure
    assert set(project.puppets) == {each.id for each in document.figures}
    assert project.selected <= {handle.id for handle in figure.handles}
    for row, frames in project.chosen_of.items():
        assert frames
        assert frames <= frames_in(document, row)
    assert playback.current_frame(session, project) in document.frames
    for each in document.figures:
        frames = [key.frame for key in each.keys]
        assert frames
        assert frames == sorted(set(frames))
        assert all(frame in document.frames for frame in frames)
        for key in each.keys:
            check_pose(each, key.pose)
    check_joints(project)
    if project.unkeyed is not None:
        check_pose(figure, project.unkeyed)


def check_joints(project: Project) -> None:
    """Fail where a layer is not drawn at the point that it hangs by."""
    for figure in project.document.figures:
        child, joint = project.puppets[figure.id].shown, project.document.joint_at(figure, 0)
        if joint is None or joint.to is None or joint.keeps or len(figure.joints) > 1:
            continue
        parent = project.puppets[joint.to].shown
        if child is None or parent is None:
            continue
        pair = (child, figure), (parent, project.document.figure(joint.to))
        if not all(each.is_current and each.clip.figure is now for each, now in pair):
            continue
        anchor = child.placement.on(np.array([child.hinge(figure.anchor).place]))[0]
        at = parent.placement.on(np.array([parent.hinge(joint.at).place]))[0]
        size = np.abs(figure.domain.outline - figure.domain.outline.mean()).max()
        factor = parent.placement.factor * parent.hinge(joint.at).turn if joint.turns else 1.0
        gap = abs(anchor - at - factor * joint.offset)
        assert gap < OPEN * size, (
            f"{figure.name} is {gap} from its joint {joint}: {child}, {parent}"
        )


def check_pose(figure: Figure, pose: Pose) -> None:
    """Fail unless a pose is of a figure, and its certificate is true."""
    assert set(pose.targets) == {handle.id for handle in figure.handles}
    assert len(pose.phi) == len(pose.psi) == sum(map(len, figure.domain.cages))
    assert len(pose.logs) == len(figure.domain.holes)
    assert np.isfinite(pose.phi).all()
    assert np.isfinite(pose.psi).all()
    if pose.certificate.certified:
        assert _is_true(figure.domain, pose)


@lru_cache(maxsize=512)
def _is_true(domain: Domain, pose: Pose) -> bool:
    told: Certificate = pose.certificate
    allowed = Bounds(
        k=told.k + SLACK,
        sigma_a=max(told.sigma_a, 1.0) + SLACK,
        sigma_b=min(told.sigma_b, 1.0) - SLACK,
    )
    shape = HarmonicMap(
        cage=domain.cage, phi=pose.phi, psi=pose.psi, holes=domain.holes, logs=pose.logs
    )
    return certify(shape, _boundary(domain), allowed).certified


@lru_cache(maxsize=8)
def _boundary(domain: Domain) -> Boundary:
    require_domain(domain)
    return Boundary.sample(domain.outline, domain.cage, domain.holes)
