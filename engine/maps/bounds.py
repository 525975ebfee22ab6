"""Bounds on the distortion: those of the person, and local ones of the solver."""

from dataclasses import dataclass
from math import isfinite

import numpy as np

from engine.arrays import Floats, as_reals
from engine.errors import EngineError
from engine.geometry import next_on_loop
from engine.maps.boundary import Boundary

IMPOSSIBLE_SIGMA_A = "The limit of sigma_a must be a finite number above 1, not {value:g}."
IMPOSSIBLE_BOUND = "The limit of {name} must be between 0 and 1, not {value:g}."


@dataclass(frozen=True, slots=True, kw_only=True)
class LocalBounds:
    """Limits that hold at every point of a shape: k ≤ `k`, σ_a ≤ `sigma_a`, σ_b ≥ `sigma_b`.

    Any numbers, or arrays (s,) with one limit for each of a shape's own samples. A segment between
    two samples is held to the wider limits of both. A person sets `Bounds`. The solver also uses
    limits that the identity breaks, for example while an enlarged map moves into tighter bounds.
    """

    k: float | Floats
    sigma_a: float | Floats
    sigma_b: float | Floats

    def allow(self, *, k: float | Floats, sigma_a: float | Floats, sigma_b: float | Floats) -> bool:
        """Whether distortions up to these values are within the limits; never for NaN."""
        # One call of `np.all`, which takes longer than all comparisons of numbers.
        within = (k <= self.k) & (sigma_a <= self.sigma_a) & (sigma_b >= self.sigma_b)
        return bool(np.all(within))

    def include(self, limits: "LocalBounds") -> bool:
        """Whether maps within the other limits are within these."""
        return self.allow(k=limits.k, sigma_a=limits.sigma_a, sigma_b=limits.sigma_b)

    def at(self, boundary: Boundary) -> "LocalBounds":
        """Return the limits at all samples of a boundary, added samples included."""
        limits = self.k, self.sigma_a, self.sigma_b
        are_local = [isinstance(limit, np.ndarray) for limit in limits]
        if not any(are_local) or (all(are_local) and not boundary.has_added_samples):
            return self
        first, second = boundary.original_neighbours
        count = 1 + int(first[-1])
        k, sigma_a, sigma_b = (np.broadcast_to(limit, count) for limit in limits)
        return LocalBounds(
            k=np.maximum(k[first], k[second]),
            sigma_a=np.maximum(sigma_a[first], sigma_a[second]),
            sigma_b=np.minimum(sigma_b[first], sigma_b[second]),
        )

    def scaled_by_stiffness(self, boundary: Boundary) -> "LocalBounds":
        """Return the limits of a shape, tighter where it is stiff.

        Where the stiffness s is above 1, ln σ_a, ln σ_b and k are the shape's values over √s. Each
        segment is held to the limits of its stiffer end: a sample takes the tightest limits of its
        neighbours.
        """
        own, ends = boundary.original_samples
        stiffness = np.maximum(boundary.stiffness[own], 1.0)
        if np.all(stiffness == 1.0):
            return self
        following = next_on_loop(np.array(ends[:-1]), len(own))
        before = np.empty_like(stiffness)
        before[following] = stiffness
        stiffest = np.maximum(np.maximum(stiffness, stiffness[following]), before)
        return self.scaled_by(stiffest)

    def scaled_by(self, stiffness: Floats) -> "LocalBounds":
        """Return the limits of parts with this stiffness (s,), at least 1."""
        root = np.sqrt(stiffness)
        return LocalBounds(
            k=self.k / root,
            sigma_a=np.exp(np.log(self.sigma_a) / root),
            sigma_b=np.exp(np.log(self.sigma_b) / root),
        )

    def loosened(self, limits: "LocalBounds", shares: Floats) -> "LocalBounds":
        """Return the limits moved towards wider ones by a share (s,) of the way, from 0 to 1."""
        further = 1.0 - shares
        return LocalBounds(
            k=further * self.k + shares * np.maximum(self.k, limits.k),
            sigma_a=self.sigma_a**further * np.maximum(self.sigma_a, limits.sigma_a) ** shares,
            sigma_b=self.sigma_b**further * np.minimum(self.sigma_b, limits.sigma_b) ** shares,
        )

    def towards_identity(self, fraction: float) -> "LocalBounds":
        """Return the limits moved by a fraction of their distance from the identity."""
        rest = 1.0 - fraction
        return LocalBounds(
            k=rest * self.k,
            sigma_a=1.0 + rest * (self.sigma_a - 1.0),
            sigma_b=1.0 + rest * (self.sigma_b - 1.0),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Bounds(LocalBounds):
    """Limits that a person sets; the identity, where every drag starts, lies strictly within them.

    Parameters
    ----------
    k : float
        Largest conformal distortion |f_z̄| / |f_z|, between 0 and 1.
    sigma_a : float
        Largest stretch, above 1.
    sigma_b : float
        Smallest stretch, between 0 and 1.

    Raises
    ------
    EngineError
        If the identity is not strictly within the bounds.
    """

    k: float = 0.8
    sigma_a: float = 5.0
    sigma_b: float = 0.2

    def joined(self, other: "Bounds") -> "Bounds":
        """Return the wider of two limits each."""
        return Bounds(
            k=max(self.k, other.k),
            sigma_a=max(self.sigma_a, other.sigma_a),
            sigma_b=min(self.sigma_b, other.sigma_b),
        )

    def __post_init__(self) -> None:
        for name in ("k", "sigma_a", "sigma_b"):
            as_reals(getattr(self, name), f"The bound on {name}")
        if not 0 < self.k < 1:
            raise EngineError(IMPOSSIBLE_BOUND, name="k", value=self.k)
        if not (self.sigma_a > 1 and isfinite(self.sigma_a)):
            raise EngineError(
                IMPOSSIBLE_SIGMA_A,
                value=self.sigma_a,
            )
        if not 0 < self.sigma_b < 1:
            raise EngineError(IMPOSSIBLE_BOUND, name="sigma_b", value=self.sigma_b)
