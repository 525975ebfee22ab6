"""Target errors of a pose, and their cause."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import log
from typing import NamedTuple

from app.document.keyframe import Pose
from app.document.layer import Layer
from app.document.queries.material.limbs import find_limbs
from app.document.queries.material.local_limits import uses_local_limits
from app.document.queries.memo import memoized_on
from app.texts import N_, _
from engine.arrays import Complexes
from engine.domain import MeshedDomain
from engine.geometry import diameter
from engine.maps import Bounds, distortion

# Fraction of the outline's diameter from which a target error counts. A free handle always stays a
# little off its target, since it pulls against the stiffness of the shape.
LEAST_TARGET_ERROR = 0.005
AT_LIMIT = 0.97  # share of a limit from which a pose cannot go on
LIMIT_NAMES = {"k": "shear", "σa": "stretch", "σb": "squeeze"}
TINY = 1e-300  # in place of a squeeze that is not proven to be above 0
HELD_BY_LIMITS = N_("held back by the limits")


class LimitUse(NamedTuple):
    """Used share of a limit, from 0 without distortion to 1 at the limit."""

    name: str
    value: float
    limit: float
    share: float

    @property
    def word(self) -> str:
        """Name of the limited quantity."""
        return LIMIT_NAMES[self.name]

    @property
    def is_all(self) -> bool:
        """Whether the limit is reached."""
        return self.share > AT_LIMIT


class DistortionRange(NamedTuple):
    """Largest k and σ_a, and smallest σ_b, of a whole drawing at one time."""

    k: float
    sigma_a: float
    sigma_b: float

    @classmethod
    def of(cls, pose: Pose) -> "DistortionRange":
        """Return the proven range of a pose."""
        certificate = pose.certificate
        return cls(certificate.k, certificate.sigma_a, certificate.sigma_b)

    @classmethod
    def measured(cls, fz: Complexes, fzbar: Complexes) -> "DistortionRange":
        """Return the range of a map with these derivatives at sampled points, each (p,)."""
        return cls(
            k=float(distortion.k(fz, fzbar).max()),
            sigma_a=float(distortion.sigma_a(fz, fzbar).max()),
            sigma_b=float(distortion.sigma_b(fz, fzbar).min()),
        )

    def joined(self, other: "DistortionRange") -> "DistortionRange":
        """Return the range that contains both."""
        return DistortionRange(
            k=max(self.k, other.k),
            sigma_a=max(self.sigma_a, other.sigma_a),
            sigma_b=min(self.sigma_b, other.sigma_b),
        )

    def beyond(self, other: "DistortionRange") -> "DistortionRange":
        """Return the excess of each value over the other range, at least 0."""
        return DistortionRange(
            k=max(self.k - other.k, 0.0),
            sigma_a=max(self.sigma_a - other.sigma_a, 0.0),
            sigma_b=max(other.sigma_b - self.sigma_b, 0.0),
        )

    def reached(self, bounds: Bounds) -> tuple[str, ...]:
        """Return the names of the limits that hold the shape back, the most used first.

        The first is always listed; further ones are listed if they are reached.
        """
        first, *others = sorted(self.uses(bounds), key=lambda use: -use.share)
        return (first.word, *(use.word for use in others if use.is_all))

    def uses(self, bounds: Bounds) -> tuple[LimitUse, ...]:
        """Return the used share of each limit; for stretch and squeeze, of the logarithms."""
        share_a = log(self.sigma_a) / log(bounds.sigma_a)
        share_b = log(max(self.sigma_b, TINY)) / log(bounds.sigma_b)
        return (
            LimitUse("k", self.k, bounds.k, self.k / bounds.k),
            LimitUse("σa", self.sigma_a, bounds.sigma_a, share_a),
            LimitUse("σb", self.sigma_b, bounds.sigma_b, share_b),
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TargetErrors:
    """The handles that miss their targets in a pose."""

    errors: Mapping[int, float]  # in pixels by handle id; other handles have no entry
    # Whether the limits are the cause. Otherwise other handles and the shape's stiffness are.
    at_limits: bool

    @property
    def reason(self) -> str:
        """The cause in words."""
        if self.at_limits:
            return _(HELD_BY_LIMITS)
        return _("held back by the other handles and the shape's stiffness")


def misses_target(layer: Layer, lag: float) -> bool:
    """Return whether a handle at this distance in pixels misses its target."""
    return lag > _least_target_error(layer.domain)


@memoized_on
def _least_target_error(domain: MeshedDomain) -> float:
    return LEAST_TARGET_ERROR * diameter(domain.outline)


@memoized_on
def measure_target_errors(layer: Layer, pose: Pose) -> TargetErrors:
    """Return the handles of a layer that miss their targets, without sprung handles.

    Joints of bones are left out: their targets are places of bones and not of the drawing. Rigid
    ends of limbs are where their rigid parts carry them.
    """
    limbs, lags = find_limbs(layer), dict(layer.target_errors(pose))
    if limbs is not None:
        placed = limbs.locate(layer.map_of(pose)(limbs.points)).places
        for identity in limbs.rigid_ends & lags.keys():
            lags[identity] = abs(placed[identity] - pose.targets[identity].position)
    lags = {
        identity: lag
        for identity, lag in lags.items()
        if identity not in layer.sprung_handles | layer.bone_joints and misses_target(layer, lag)
    }
    # The proven range is that of the whole drawing, joints of bones included.
    at_limits = any(use.is_all for use in DistortionRange.of(pose).uses(layer.widest_bounds)) or (
        bool(lags) and uses_local_limits(layer, pose, AT_LIMIT)
    )
    return TargetErrors(errors=lags, at_limits=at_limits)
