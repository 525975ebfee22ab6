"""Bounds that widen in fixed levels, independent of the requested bounds.

Within tight bounds there are few valleys, and the energy of a valley only sinks while the bounds
widen. Searches under tight and wide bounds are the same as long as the level is tighter than both.
So the result of wider bounds is hardly ever worse.
"""

from math import exp, inf, tanh

import numpy as np

from engine.deform.model.barrier import BarrierBounds

# Width of the first level; each next level is this many times as wide.
FIRST_LEVEL_WIDTH = 0.35
WIDER = 1.4


def exceed_first_level(walls: BarrierBounds) -> bool:
    return not are_same_bounds(homotopy_level(walls, FIRST_LEVEL_WIDTH), walls)


def homotopy_level(inside: BarrierBounds, reach: float) -> BarrierBounds:
    """Return barrier bounds, at most as wide as a level.

    Parameters
    ----------
    reach : float
        Width of the level, a logarithm of stretches: σ_a = exp(reach), σ_b = exp(−reach), and the k
        where both are attained. Infinite for the unchanged bounds.
    """
    return BarrierBounds(
        k=np.minimum(inside.k, tanh(reach)),
        sigma_a=np.minimum(inside.sigma_a, np.exp(reach)),
        sigma_b=np.maximum(inside.sigma_b, exp(-reach)),
    )


def are_same_bounds(walls: BarrierBounds, others: BarrierBounds) -> bool:
    return all(map(np.array_equal, walls, others))


def next_level_width(inside: BarrierBounds, reach: float) -> float:
    """Return the width of the next level, infinite where the level holds all of the bounds."""
    wider = WIDER * reach
    return inf if are_same_bounds(homotopy_level(inside, wider), inside) else wider
