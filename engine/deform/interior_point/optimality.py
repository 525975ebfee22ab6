"""Optimality of a map within its bounds, and the active bounds.

With the multipliers weight / c of the barrier, the gain that Newton's model expects measures the
projected gradient; the multipliers times c are the energy that the barrier holds back.
"""

from typing import NamedTuple

import numpy as np

from engine.arrays import Floats
from engine.deform.model.barrier import Barrier, BarrierBounds
from engine.maps import Boundary

# A bound is active under two conditions. Moving it all the way to the identity, or at least by a
# tenth, would to first order cost more than this part of the energy. And the energy that it holds
# back is so many times the barrier's own: next to the identity the ratio is 2 without any force.
ACTIVE = 1e-4
LEAST_MOVED = 0.1
PRESSING = 3.0
# In the order of a barrier's.
BOUNDS = ("k", "sigma_b", "sigma_a")


class ActiveBound(NamedTuple):
    """A bound that holds back a pose.

    Parameters
    ----------
    name : str
        "k", "sigma_a" or "sigma_b".
    multiplier : float
        By how much the energy would fall, to first order, if the bound were moved by 1 away from
        the identity.
    place : complex
        Point of the outline at rest with the largest pressure.
    """

    name: str
    multiplier: float
    place: complex


class Optimality(NamedTuple):
    """Distance of a map from a minimum.

    Parameters
    ----------
    measure : float
        Expected gain and complementarity over the energy; 0 at a minimum.
    gap : float
        Estimate of the remaining gain, exact for a convex objective.
    """

    measure: float = np.inf
    gap: float = np.inf
    active: tuple[ActiveBound, ...] = ()

    @classmethod
    def of(
        cls,
        a: Floats,
        b: Floats,
        *,
        gain: float,
        energy: float,
        boundary: Boundary,
        barrier: Barrier,
        bounds: BarrierBounds,
    ) -> "Optimality":
        """Measure a map by a = |f_z| and b = |f_z̄| (m,) at the samples, and by its last step."""
        weight = barrier.weight * float(boundary.barrier_weights.sum())
        complementarity = 3.0 * weight
        multipliers = boundary.barrier_weights * (barrier.weight / barrier.margins(a, b))
        walls = barrier.bounds
        # The derivatives of c = u² − b² by the bound, away from the identity.
        prices = multipliers * np.array(
            [2 * walls.k * a * a, 2 * (a - walls.sigma_b), 2 * (walls.sigma_a - a)]
        )
        ways = np.array([bounds.k, 1.0 - bounds.sigma_b, bounds.sigma_a - 1.0])
        held = (prices * ways).sum(axis=1)
        moved = (prices * np.maximum(ways, LEAST_MOVED)).sum(axis=1)
        active = (moved > ACTIVE * energy) & (held > PRESSING * weight)
        return cls(
            measure=float((gain + complementarity) / energy),
            gap=gain + 2.0 * complementarity,
            active=tuple(
                ActiveBound(name, float(price.sum()), complex(boundary.points[price.argmax()]))
                for name, price, is_active in zip(BOUNDS, prices, active, strict=True)
                if is_active
            ),
        )
