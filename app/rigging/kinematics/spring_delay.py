"""The frequency of a spring that follows a swing by a given delay."""

import math

from scipy.optimize import brentq

from engine.arrays import as_number
from engine.errors import EngineError

STEEPEST = 2.0  # largest ratio of the swing's frequency over the spring's


def find_spring_frequency(swing: float, delay: float, damping: float) -> float:
    """Return the frequency, in Hz, of a spring whose place follows a steady swing by a delay.

    Parameters
    ----------
    swing : float
        Frequency of the swing of the spring's base, in Hz.
    delay : float
        Share of a period by which the spring's place is later than its base, above 0.
    damping : float
        ζ of the spring.

    Raises
    ------
    EngineError
        If no spring of this damping is so late.

    Notes
    -----
    From ö + 2ζωȯ + ω²o = −q̈, the place q + o is (1 + 2iζr)/(1 − r² + 2iζr) times q, with r the
    ratio of the frequencies. It is later by the angle of 1 − (1 − 4ζ²)r² + 2iζr³.
    """
    swing = as_number(swing, "The frequency of a swing", above=0)

    def remaining(ratio: float) -> float:
        real = 1 - (1 - 4 * damping**2) * ratio**2
        return math.atan2(2 * damping * ratio**3, real) - math.tau * delay

    if not (delay > 0 and remaining(STEEPEST) > 0):
        raise EngineError(
            "A spring with a damping of {damping:g} cannot be later by {delay:g} of a period.",
            damping=damping,
            delay=delay,
        )
    return swing / float(brentq(remaining, 0.0, STEEPEST))
