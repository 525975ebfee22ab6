"""Other bounds or another domain under the same animation: every key is solved again."""

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from app.document.keyframe import Pose, Target
from app.document.model import Document
from app.document.settings import Meshing
from app.posing import Drag, Rig, fit_map
from engine.arrays import Bytes
from engine.deform.certificate import certify
from engine.domain import Domain, build_domain
from engine.harmonic_map import HarmonicMap
from engine.polygon import contains

MOST_STEPS = 600


class Rebuilt(NamedTuple):
    """Another domain, the keys' poses over its cage, and what was remedied, in words."""

    domain: Domain
    poses: tuple[Pose, ...]
    notices: tuple[str, ...]


def solve_keys(document: Document) -> tuple[Pose, ...]:
    """Return each key's pose, pulled to its targets again within the document's bounds.

    Each begins with the key's own map, or where the bounds do not allow that, with the drawing at
    rest.
    """
    rig = Rig.of(document)
    return tuple(
        _pulled(rig, key.pose if _is_within(document, key.pose) else _rest(rig), key.pose.targets)
        for key in document.keys
    )


def rebuild_domain(document: Document, picture: Bytes, meshing: Meshing) -> Rebuilt:
    """Build a domain from the picture again, and bring the keys over to it.

    Parameters
    ----------
    document : Document
    picture : uint8, shape (h, w, 4)
        The document's, decoded.
    meshing : Meshing

    Raises
    ------
    EngineError, LissomError
        If there is no domain, or a handle lies outside of it.
    """
    domain, notices = build_domain(
        picture,
        triangles=meshing.triangles,
        detail=meshing.detail,
        tolerance=meshing.tolerance,
    )
    rig = Rig.of(_on_domain(document, domain))
    poses = tuple(
        _pulled(rig, _carried_over(document, key.pose, rig), key.pose.targets)
        for key in document.keys
    )
    return Rebuilt(domain, poses, notices)


def _on_domain(document: Document, domain: Domain) -> Document:
    """Return the document over another domain, with the drawing at rest in every key."""
    rest = HarmonicMap.identity(domain.cage)
    keys = tuple(
        replace(key, pose=replace(key.pose, phi=rest.phi, psi=rest.psi)) for key in document.keys
    )
    return replace(document, domain=domain, keys=keys)


def _rest(rig: Rig) -> Pose:
    rest = HarmonicMap.identity(rig.document.domain.cage)
    certificate = certify(rest, rig.deformer.boundary, rig.deformer.bounds)
    return Pose(targets={}, phi=rest.phi, psi=rest.psi, certificate=certificate)


def _is_within(document: Document, pose: Pose) -> bool:
    certificate = pose.certificate
    return document.bounds.allow(
        k=certificate.k, sigma_a=certificate.sigma_a, sigma_b=certificate.sigma_b
    )


def _pulled(rig: Rig, start: Pose, targets: Mapping[int, Target]) -> Pose:
    drag = Drag.begin(rig, start)
    return drag.towards(targets, MOST_STEPS).pose(targets)


def _carried_over(document: Document, pose: Pose, rig: Rig) -> Pose:
    """Return the pose over the rig's cage that is nearest to one over the document's."""
    boundary = rig.deformer.boundary
    inside = contains(document.domain.outline, boundary.points)
    points = boundary.points[inside]
    fz, fzbar = document.map_of(pose).derivatives(points)
    fitted = fit_map(boundary, fz, fzbar, document.map_of(pose)(points), inside=inside)
    certificate = certify(fitted, boundary, rig.deformer.bounds)
    if not certificate.certified:
        return _rest(rig)
    return Pose(targets=pose.targets, phi=fitted.phi, psi=fitted.psi, certificate=certificate)
