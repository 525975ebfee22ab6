"""Which handles a pose does not bring to their targets, and what holds them back."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import log
from typing import NamedTuple

from app.document.keyframe import Pose
from app.document.layer import Layer
from app.document.queries.boundary_stiffness import uses_local_limits
from app.document.queries.memo import memoized_on
from engine.arrays import Complexes
from engine.geometry import diameter
from engine.maps import Bounds, distortion

# Of the outline's diameter: a handle this far from its target falls short. A free handle
# always gives in a little, since it pulls against the stiffness of the shape.
LEAST_TARGET_ERROR = 0.005
AT_LIMIT = 0.97  # of a limit: so much of it is used where a pose cannot go on
LIMIT_NAMES = {"k": "shear", "σa": "stretch", "σb": "squeeze"}
TINY = 1e-300  # in place of a stretch that is not proven to be above 0
HELD_BY_LIMITS = "held back by the limits"


class LimitUse(NamedTuple):
    """How much of a limit is used; 1 where it is reached, 0 where nothing is distorted."""

    name: str
    value: float
    limit: float
    share: float

    @property
    def word(self) -> str:
        """What is limited, in a word."""
        return LIMIT_NAMES[self.name]

    @property
    def is_all(self) -> bool:
        """Whether nothing is left of it that a pose could use."""
        return self.share > AT_LIMIT


class DistortionRange(NamedTuple):
    """The largest k and σ_a of the whole drawing at one moment, and its smallest σ_b."""

    k: float
    sigma_a: float
    sigma_b: float

    @classmethod
    def of(cls, pose: Pose) -> "DistortionRange":
        """Return what is proven of a pose."""
        certificate = pose.certificate
        return cls(certificate.k, certificate.sigma_a, certificate.sigma_b)

    @classmethod
    def measured(cls, fz: Complexes, fzbar: Complexes) -> "DistortionRange":
        """Return the extremes of a map whose derivatives at some points are these, each (p,)."""
        return cls(
            k=float(distortion.k(fz, fzbar).max()),
            sigma_a=float(distortion.sigma_a(fz, fzbar).max()),
            sigma_b=float(distortion.sigma_b(fz, fzbar).min()),
        )

    def joined(self, other: "DistortionRange") -> "DistortionRange":
        """Return the worse of both."""
        return DistortionRange(
            k=max(self.k, other.k),
            sigma_a=max(self.sigma_a, other.sigma_a),
            sigma_b=min(self.sigma_b, other.sigma_b),
        )

    def beyond(self, other: "DistortionRange") -> "DistortionRange":
        """Return by how much each is worse than another's, or 0."""
        return DistortionRange(
            k=max(self.k - other.k, 0.0),
            sigma_a=max(self.sigma_a - other.sigma_a, 0.0),
            sigma_b=max(other.sigma_b - self.sigma_b, 0.0),
        )

    def reached(self, bounds: Bounds) -> tuple[str, ...]:
        """Return what is limited so that a shape which some limit holds back cannot go on.

        In words; that of which most is used comes first.
        """
        first, *others = sorted(self.uses(bounds), key=lambda use: -use.share)
        return (first.word, *(use.word for use in others if use.is_all))

    def uses(self, bounds: Bounds) -> tuple[LimitUse, ...]:
        """Return how much of each limit is used; stretches count by their logarithms."""
        share_a = log(self.sigma_a) / log(bounds.sigma_a)
        share_b = log(max(self.sigma_b, TINY)) / log(bounds.sigma_b)
        return (
            LimitUse("k", self.k, bounds.k, self.k / bounds.k),
            LimitUse("σa", self.sigma_a, bounds.sigma_a, share_a),
            LimitUse("σb", self.sigma_b, bounds.sigma_b, share_b),
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TargetErrors:
    """The handles that fall short of their targets in a pose."""

    errors: Mapping[
        int, float
    ]  # by how many pixels, by their ids; those that arrived are not in it
    # Whether the limits hold them back. Else the other handles and the shape's stiffness do.
    at_limits: bool

    @property
    def reason(self) -> str:
        """What holds them back, in words."""
        if self.at_limits:
            return HELD_BY_LIMITS
        return "held back by the other handles and the shape's stiffness"


def misses_target(layer: Layer, lag: float) -> bool:
    """Tell whether a handle so many pixels from its target has not arrived there."""
    return lag > _least_target_error(layer)


@memoized_on
def _least_target_error(layer: Layer) -> float:
    return LEAST_TARGET_ERROR * diameter(layer.domain.outline)


@memoized_on
def measure_target_errors(layer: Layer, pose: Pose) -> TargetErrors:
    """Return which handles of a layer fall short in a pose, and why; none that follow does."""
    lags = {
        identity: lag
        for identity, lag in layer.target_errors(pose).items()
        if identity not in layer.sprung_handles and misses_target(layer, lag)
    }
    at_limits = any(use.is_all for use in DistortionRange.of(pose).uses(layer.bounds)) or (
        bool(lags) and uses_local_limits(layer, pose, AT_LIMIT)
    )
    return TargetErrors(errors=lags, at_limits=at_limits)
