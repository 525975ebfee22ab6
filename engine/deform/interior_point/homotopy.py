"""Walls that open on the way, from natural rungs that do not depend on the bounds of a request.

Within tight bounds there are few valleys, and a valley that is followed while the walls open only
sinks. Under tight and wide bounds such a search goes one and the same way as long as the rungs are
the tighter ones, so that what looser bounds find is hardly ever worse.
"""

from math import exp, inf, tanh

import numpy as np

from engine.deform.model import BarrierBounds

# The first rung; each next one is this many times as wide.
FIRST_LEVEL_WIDTH = 0.35
WIDER = 1.4


def exceed_first_level(walls: BarrierBounds) -> bool:
    """Tell whether walls are wider than the first rung."""
    return not are_same_bounds(homotopy_level(walls, FIRST_LEVEL_WIDTH), walls)


def homotopy_level(inside: BarrierBounds, reach: float) -> BarrierBounds:
    """Return walls, at most as wide as a rung.

    Parameters
    ----------
    inside : BarrierBounds
    reach : float
        Of the rung, a logarithm of stretches: σ_a = exp(reach) and σ_b = exp(−reach), and what k is
        where both are attained. Infinite for the walls themselves.
    """
    return BarrierBounds(
        k=np.minimum(inside.k, tanh(reach)),
        sigma_a=np.minimum(inside.sigma_a, np.exp(reach)),
        sigma_b=np.maximum(inside.sigma_b, exp(-reach)),
    )


def are_same_bounds(walls: BarrierBounds, others: BarrierBounds) -> bool:
    """Tell whether walls stand at one place."""
    return all(map(np.array_equal, walls, others))


def next_level_width(inside: BarrierBounds, reach: float) -> float:
    """Return the reach of the rung after this one, infinite where it is wide enough."""
    wider = WIDER * reach
    return inf if are_same_bounds(homotopy_level(inside, wider), inside) else wider
