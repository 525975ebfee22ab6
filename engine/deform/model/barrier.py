"""Logarithmic barrier of the three bounds, with a primal–dual Hessian.

Each bound reads b < u with u linear in a = |f_z|: k a for the conformal distortion, a − sigma_b for
the smallest stretch, sigma_a − a for the largest. As c = u² − b² > 0 it is smooth at b = 0, and its
barrier is −weight · log c. The Hessian of the barrier is (weight / c²) ∇c ∇cᵀ − (weight / c) ∇²c.
With a dual variable y that follows weight / c from step to step it becomes (y / c) ∇c ∇cᵀ − y ∇²c,
the condensed system of a primal–dual interior point method (Nocedal and Wright, ch. 19). The exact
Hessian trusts a step near a bound no longer than the slack, and a map that once touched a bound
crawls along it.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from engine.arrays import Floats, Indices, freeze
from engine.deform.model.energy import RadialDerivatives
from engine.maps import Boundary, LocalBounds

# A dual variable stays within this factor of weight / c. Measured: with a larger factor, samples
# with almost vanished duals stop every step by curvature that the Hessian omits.
DUAL_RANGE = 100.0
# The barrier bounds lie inside the limits by this part of the way to the identity.
MARGIN = 3e-4


class BarrierBounds(NamedTuple):
    """Bounds where a barrier becomes infinite: separate limits (m,) for each sample."""

    k: Floats
    sigma_a: Floats
    sigma_b: Floats

    @classmethod
    def for_samples(cls, limits: LocalBounds, count: int) -> "BarrierBounds":
        """Return the limits for each of `count` samples; equal limits are repeated."""
        return cls(*(np.full(count, x) for x in (limits.k, limits.sigma_a, limits.sigma_b)))

    @classmethod
    def at(cls, limits: LocalBounds, boundary: Boundary) -> "BarrierBounds":
        """Return barrier bounds at the limits of a boundary's samples."""
        return cls.for_samples(limits.at(boundary), len(boundary.points))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Barrier:
    """A barrier: its bounds, its weight, and the dual variables of its Hessian.

    Parameters
    ----------
    duals : float64, shape (3, m), or None
        One for each bound and sample, positive; None for weight / c, the exact Hessian.
    """

    bounds: BarrierBounds
    weight: float
    duals: Floats | None = None

    def slacks(self, a: Floats, b: Floats) -> Floats:
        """Return u − b (3, m) of each bound, positive within the bounds."""
        u = self.distances(a)
        slacks: Floats = u - b
        return slacks

    def margins(self, a: Floats, b: Floats) -> Floats:
        """Return c = u² − b² (3, m) of each bound, positive within the bounds."""
        u = self.distances(a)
        margins: Floats = (u - b) * (u + b)
        return margins

    def margin_changes(self, a: Floats, b: Floats, da: Floats, db: Floats) -> Floats:
        """Return the change of c (3, m), to first order, for changes of a and b."""
        u, u_a = self.distances(a), self._slopes()
        changes: Floats = 2.0 * (u * u_a * da - b * db)
        return changes

    def margin_gradient(self, a: Floats, factors: Floats) -> tuple[Floats, Floats]:
        """Return the derivatives (m,) of Σ factor · c over the bounds: by a, and by b over b."""
        u, u_a = self.distances(a), self._slopes()
        return (2.0 * factors * u * u_a).sum(axis=0), (-2.0 * factors).sum(axis=0)

    def value(self, a: Floats, b: Floats) -> Floats:
        """Return the barrier at each sample; ∞ everywhere if one sample is outside."""
        u = self.distances(a)
        slacks = u - b
        if not slacks.min() > 0:
            return np.full(np.shape(a), np.inf)
        of_k, of_sigma_b, of_sigma_a = slacks * (u + b)
        density: Floats = -self.weight * np.log(of_k * of_sigma_b * of_sigma_a)
        return density

    def derivatives(self, a: Floats, b: Floats) -> RadialDerivatives:
        """Return the derivatives of the barrier, strictly within the bounds."""
        u, u_a = self.distances(a), self._slopes()
        c = (u - b) * (u + b)
        central, dual = self.weight / c, self._duals_at(c)
        # The positive part of −y ∇²c: never less than the barrier's own.
        bent = np.maximum(dual, central)
        by_a, b_per_b = self.margin_gradient(a, -central)
        return RadialDerivatives(
            a=by_a,
            b_per_b=b_per_b,
            aa=(u_a * u_a * dual * (4.0 * u * u / c - 2.0)).sum(axis=0),
            ab=(-4.0 * dual * u_a * u * b / c).sum(axis=0),
            bb=(dual * (4.0 * b * b / c + 2.0)).sum(axis=0),
            around_a=(-2.0 * np.where(u_a < 0, bent, dual) * u_a * u / a).sum(axis=0),
            around_b=2.0 * bent.sum(axis=0),
        )

    def current_duals(self, a: Floats, b: Floats) -> Floats:
        """Return the dual variables (3, m), clamped for this point."""
        return self._duals_at(self.margins(a, b))

    def _duals_at(self, margins: Floats) -> Floats:
        central = self.weight / margins
        if self.duals is None:
            return central
        return np.minimum(np.maximum(self.duals, central / DUAL_RANGE), central * DUAL_RANGE)

    def next_duals(self, a: Floats, b: Floats, da: Floats, db: Floats) -> Floats:
        """Return the dual variables (3, m) after Newton's step for dual · c = weight.

        Each is stopped before it reaches zero. `da`, `db` are the changes of a and b in the step.
        """
        u = self.distances(a)
        margins = (u - b) * (u + b)
        duals = self._duals_at(margins)
        ahead = margins + 2.0 * (u * self._slopes() * da - b * db)
        return np.maximum(duals + (self.weight - duals * ahead) / margins, 0.1 * duals)

    def distances(self, a: Floats) -> Floats:
        """Return u (3, m) of the bounds on k, σ_b and σ_a."""
        k, sigma_a, sigma_b = self.bounds
        distances = np.empty((3, len(a)))
        np.multiply(k, a, out=distances[0])
        np.subtract(a, sigma_b, out=distances[1])
        np.subtract(sigma_a, a, out=distances[2])
        return distances

    def _slopes(self) -> Floats:
        """Return du/da (3, m)."""
        slopes = np.ones((3, len(self.bounds.k)))
        slopes[0] = self.bounds.k
        slopes[2] = -1.0
        return slopes


def interpolate_duals(duals: Floats, segments: Indices, ends: Indices) -> Floats:
    """Return dual variables (3, m) with one more sample in each of these segments.

    Parameters
    ----------
    segments, ends : intp, shape (s,)
        The samples at which these segments start, ascending, and end.
    """
    between = np.maximum(duals[:, segments], duals[:, ends])
    return freeze(np.insert(duals, segments + 1, between, axis=1))
