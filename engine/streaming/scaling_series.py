"""ρ(t) as a series: its minimum over the outline costs more than a frame may."""

from collections.abc import Generator

import numpy as np

from engine.arrays import readonly
from engine.chebyshev import basis, nodes, to_coefficients
from engine.interpolation import IntegratedInbetweens
from engine.streaming.channels import weights_at
from engine.streaming.series import ScalarSeries

DEGREE = 6
LAST_TERMS = 2
FIRST_PIECES = 4
SHORTEST = 2.0**-26
BESIDE_KEY = 1e-6  # ρ may jump at a keyframe; the limit is taken from this far away
CHECKED = 0.1  # place between the nodes, in [−1, 1], where each piece is compared with ρ


def approximate_rho(
    inbetweens: IntegratedInbetweens, tolerance: float
) -> Generator[None, None, ScalarSeries]:
    """Approximate ρ between two keyframes; a few values are worked out at each step.

    Being a minimum, ρ has a kink wherever another point of the outline or another of the three
    bounds takes over. Pieces of time are halved towards the kinks until what they do to ρ is below
    the tolerance.

    Parameters
    ----------
    inbetweens : IntegratedInbetweens
        Of two keyframes.
    tolerance : float
        Of ρ.
    """
    known: dict[float, float] = {}

    def rho(time: float) -> float:
        time = min(max(time, BESIDE_KEY), 1.0 - BESIDE_KEY)
        if time not in known:
            known[time] = inbetweens.rho(weights_at(time))
        return known[time]

    cuts = np.linspace(0.0, 1.0, FIRST_PIECES + 1)
    pending = [(float(a), float(b)) for a, b in zip(cuts[-2::-1], cuts[:0:-1], strict=True)]
    breaks, pieces = [0.0], []
    while pending:
        start, end = pending.pop()
        half = (end - start) / 2
        values = np.array([rho(start + half * (1 + x)) for x in nodes(DEGREE)])
        coefficients = to_coefficients(DEGREE) @ values
        missed = basis(CHECKED, DEGREE + 1) @ coefficients - rho(start + half * (1 + CHECKED))
        yield
        worst = max(abs(float(missed)), float(np.abs(coefficients[-LAST_TERMS:]).max()))
        if worst <= tolerance or end - start <= SHORTEST:
            breaks.append(end)
            pieces.append(coefficients)
        else:
            pending += [(start + half, end), (start, start + half)]
    return ScalarSeries(breaks=tuple(breaks), coefficients=readonly(np.array(pieces)))
