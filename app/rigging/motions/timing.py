"""Time over a cycle: phases of a motion, and shares of the cycle's frames."""

import math
from dataclasses import dataclass

import numpy as np

SAME_PHASE = 1e-9  # phases that differ by less are equal


@dataclass(frozen=True, slots=True)
class Timing:
    """The share of a cycle's time at each of its phases; whole frames make it uneven.

    `keys` are phases from 0 on, ascending, with their shares; both end with 1.
    """

    keys: tuple[tuple[float, float], ...] = ((0.0, 0.0), (1.0, 1.0))

    def share(self, phase: float) -> float:
        """Return the share at a phase; whole cycles count as 1."""
        phases, shares = zip(*self.keys, strict=True)
        whole = math.floor(phase + SAME_PHASE)
        return whole + float(np.interp(phase - whole, phases, shares))

    def between(self, first: float, last: float) -> float:
        """Return the share of time from one phase to the next time of another, below 1."""
        passed = (self.share(last) - self.share(first)) % 1.0
        return 0.0 if passed > 1 - SAME_PHASE else passed


EVEN = Timing()  # each phase at its own share
