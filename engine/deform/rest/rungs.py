"""Walls that open on the way, from natural rungs that do not depend on the bounds of a request.

Within tight bounds there are few valleys, and a valley that is followed while the walls open only
sinks. Under tight and wide bounds such a search goes one and the same way as long as the rungs are
the tighter ones, so that what looser bounds find is hardly ever worse.
"""

from math import exp, inf, tanh

import numpy as np

from engine.deform.model import Walls

# The first rung; each next one is this many times as wide.
FIRST_REACH = 0.35
WIDER = 1.4


def exceed_first_rung(walls: Walls) -> bool:
    """Tell whether walls are wider than the first rung."""
    return not is_same(rung(walls, FIRST_REACH), walls)


def rung(inside: Walls, reach: float) -> Walls:
    """Return walls, at most as wide as a rung.

    Parameters
    ----------
    inside : Walls
    reach : float
        Of the rung, a logarithm of stretches: σ_a = exp(reach) and σ_b = exp(−reach), and what k is
        where both are attained. Infinite for the walls themselves.
    """
    return Walls(
        k=np.minimum(inside.k, tanh(reach)),
        sigma_a=np.minimum(inside.sigma_a, np.exp(reach)),
        sigma_b=np.maximum(inside.sigma_b, exp(-reach)),
    )


def is_same(walls: Walls, others: Walls) -> bool:
    """Tell whether walls stand at one place."""
    return all(map(np.array_equal, walls, others))


def next_reach(inside: Walls, reach: float) -> float:
    """Return the reach of the rung after this one, infinite where it is wide enough."""
    wider = WIDER * reach
    return inf if is_same(rung(inside, wider), inside) else wider
