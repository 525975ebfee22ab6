"""Walls that open on the way, from natural rungs that do not depend on the bounds of a request.

Within tight bounds there are few valleys, and a valley that is followed while the walls open only
sinks. Under tight and wide bounds such a search goes one and the same way as long as the rungs are
the tighter ones, so that what looser bounds find is hardly ever worse.
"""

from math import exp, inf, tanh

from engine.maps import Limits

# The first rung; each next one is this many times as wide.
FIRST_REACH = 0.35
WIDER = 1.4


def exceeds_first_rung(limits: Limits) -> bool:
    """Tell whether limits are wider than the first rung."""
    first = rung(limits, FIRST_REACH)
    return not first.allow(k=limits.k, sigma_a=limits.sigma_a, sigma_b=limits.sigma_b)


def rung(inside: Limits, reach: float) -> Limits:
    """Return limits, at most as wide as a rung.

    Parameters
    ----------
    inside : Limits
    reach : float
        Of the rung, a logarithm of stretches: σ_a = exp(reach) and σ_b = exp(−reach), and what k is
        where both are attained. Infinite for the limits themselves.
    """
    return Limits(
        k=min(inside.k, tanh(reach)),
        sigma_a=min(inside.sigma_a, exp(reach)),
        sigma_b=max(inside.sigma_b, exp(-reach)),
    )


def next_reach(inside: Limits, reach: float) -> float:
    """Return the reach of the rung after this one, infinite where it is wide enough."""
    wider = WIDER * reach
    return wider if rung(inside, wider) != inside else inf
