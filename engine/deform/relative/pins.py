"""What is asked of a correction."""

from typing import NamedTuple

from engine.arrays import Complexes, Floats

# λ L² of a point that is to be where it is wanted, and of one that is only held where the base has
# it: the energy relative to the base sees no rigid motion.
FIRM, SOFT = 1e6, 1e4


class Pins(NamedTuple):
    """Where the points are wanted.

    Parameters
    ----------
    places : complex128, shape (h,)
    firmness : float64, shape (h,)
        From −1, hardly at all, over 0, as softly as what is only held, to 1.
    turns : float64, shape (h,)
        arg f_z in radians; NaN where it is free. Whole turns do not matter.
    reach : float
        How far around the points the shape gives, from 0 to 1, which is as it likes.
    """

    places: Complexes
    firmness: Floats
    turns: Floats
    reach: float = 1.0

    @property
    def stiffness(self) -> Floats:
        """λ L² of each point."""
        stiffness: Floats = SOFT ** (1.0 - self.firmness) * FIRM**self.firmness
        return stiffness
