"""What is corrected, and what is asked of it."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.geometry import RigidMotion

# λ L² of a point that is to be where it is wanted, and of one that is only held where the base has
# it: the energy relative to the base sees no rigid motion.
FIRM, SOFT = 1e6, 1e4


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Base:
    """A map at the samples of a boundary and at some points; it need not be of the span.

    Parameters
    ----------
    f, g : complex128, shape (m,)
        f_z and conj(f_z̄) at the samples.
    positions, fz : complex128, shape (h,)
        The map and f_z at the points.
    """

    f: Complexes
    g: Complexes
    positions: Complexes
    fz: Complexes

    def moved(self, motion: RigidMotion) -> "Base":
        """Return the map, and a rigid motion after it."""
        return Base(
            f=motion.factor * self.f,
            g=np.conj(motion.factor) * self.g,
            positions=motion.on(self.positions),
            fz=motion.factor * self.fz,
        )

    def plus(self, change: "Base") -> "Base":
        """Return the sum of two maps."""
        return Base(
            f=self.f + change.f,
            g=self.g + change.g,
            positions=self.positions + change.positions,
            fz=self.fz + change.fz,
        )

    def times(self, factor: float) -> "Base":
        """Return a multiple."""
        return Base(
            f=factor * self.f,
            g=factor * self.g,
            positions=factor * self.positions,
            fz=factor * self.fz,
        )


class Pins(NamedTuple):
    """Where the points are wanted.

    Parameters
    ----------
    places : complex128, shape (h,)
    firmness : float64, shape (h,)
        From 0, as softly as what is only held, to 1.
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
