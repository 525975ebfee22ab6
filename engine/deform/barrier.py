"""Logarithmic barrier of the three bounds, with a primal–dual Hessian.

Each bound reads b < u with u linear in a = |f_z|: k a for the conformal distortion, a − sigma_b for
the smallest stretch, sigma_a − a for the largest. Its barrier −log(u² − b²) is smooth at b = 0. The
first factor, the slack s = u − b, carries the wall; in the Hessian weight / s² is replaced by
dual / s, with a dual variable that follows weight / s from step to step. Near a wall the plain
Hessian trusts a step no longer than the slack, and a drag that once touched the walls crawls along
them; with the dual variables it does not (primal–dual interior point, Nocedal and Wright, ch. 19).
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Floats
from engine.deform.energy import Radial
from engine.maps import Limits

# A dual variable stays within this factor of weight / slack, so that it forgets old walls.
DUAL_RANGE = 1e4


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Barrier:
    """A barrier: its walls, its weight, and the dual variables of its Hessian.

    Parameters
    ----------
    walls : Limits
        Where it becomes infinite.
    weight : float
    duals : float64, shape (3, m), or None
        One for each bound and sample, positive; None for weight / slack, the exact Hessian.
    """

    walls: Limits
    weight: float
    duals: Floats | None = None

    def slacks(self, a: Floats, b: Floats) -> Floats:
        """Return u − b (3, m) of each bound, positive within the walls."""
        slacks: Floats = np.array([u - b for u, _ in self._distances(a)])
        return slacks

    def value(self, a: Floats, b: Floats) -> Floats:
        """Return the barrier at each sample; ∞ everywhere where one sample is not within."""
        product = np.ones(np.shape(a))
        for u, _ in self._distances(a):
            if not np.all(u > b):
                return np.full(np.shape(a), np.inf)
            product = product * (u * u - b * b)
        density: Floats = -self.weight * np.log(product)
        return density

    def derivatives(self, a: Floats, b: Floats) -> Radial:
        """Return the barrier with its derivatives, strictly within the walls."""
        first_a, b_per_b, aa, ab, bb = (np.zeros(np.shape(a)) for _ in range(5))
        duals = self.current_duals(a, b)
        for (u, u_a), dual in zip(self._distances(a), duals, strict=True):
            slack, far = u - b, u + b
            product = slack * far
            near_curvature, far_curvature = dual / slack, self.weight / (far * far)
            first_a -= 2.0 * self.weight * u_a * u / product
            b_per_b += 2.0 * self.weight / product
            aa += u_a * u_a * (near_curvature + far_curvature)
            ab += u_a * (far_curvature - near_curvature)
            bb += near_curvature + far_curvature
        return Radial(self.value(a, b), first_a, b_per_b, aa, ab, bb)

    def current_duals(self, a: Floats, b: Floats) -> Floats:
        """Return the dual variables (3, m) as they are used at this point."""
        central = self.weight / self.slacks(a, b)
        if self.duals is None:
            return central
        return np.clip(self.duals, central / DUAL_RANGE, central * DUAL_RANGE)

    def next_duals(self, a: Floats, b: Floats, a_ahead: Floats, b_ahead: Floats) -> Floats:
        """Return the dual variables (3, m) after a full Newton step to (a_ahead, b_ahead).

        Newton's step for dual · slack = weight, each stopped before it reaches zero.
        """
        duals, slacks = self.current_duals(a, b), self.slacks(a, b)
        change = (self.weight - duals * self.slacks(a_ahead, b_ahead)) / slacks
        return np.maximum(duals + change, 0.1 * duals)

    def _distances(self, a: Floats) -> tuple[tuple[Floats, float], ...]:
        """Return u and du/da of each bound."""
        walls = self.walls
        return (walls.k * a, walls.k), (a - walls.sigma_b, 1.0), (walls.sigma_a - a, -1.0)
