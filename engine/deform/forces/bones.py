"""What an armature is made of: shafts, hinges and aims; and how its shafts move."""

from collections.abc import Sequence
from math import inf
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats, Indices, readonly
from engine.errors import EngineError

# κ L² of a shaft.
SHAFT_STIFFNESS = 3e3


class Shaft(NamedTuple):
    """Points of the drawing that stay as they are to each other.

    Parameters
    ----------
    points : complex128, shape (m,)
        In the drawing.
    rest : complex128, shape (m,)
        The shape that is kept: the points themselves, or where they are in an earlier pose.
    stiffness : float
        κ L².
    """

    points: Complexes
    rest: Complexes
    stiffness: float = SHAFT_STIFFNESS


class Hinge(NamedTuple):
    """A place that two shafts, by their numbers, have in common, in the rest of each."""

    first: int
    second: int
    first_place: complex
    second_place: complex


class Aim(NamedTuple):
    """A target of a place in the rest of a shaft.

    `max_force` is its largest force, per L.
    """

    shaft: int
    place: complex
    target: complex
    max_force: float = inf


class Aims(NamedTuple):
    """Several aims, as arrays (a,)."""

    shafts: Indices
    places: Complexes
    targets: Complexes
    max_forces: Floats

    @classmethod
    def of(cls, aims: Sequence[Aim], count: int) -> "Aims | None":
        """Prepare aims of an armature with so many shafts.

        Raises
        ------
        EngineError
            If an aim names a shaft that does not exist, or its force is not positive.
        """
        for aim in aims:
            if aim.shaft not in range(count):
                raise EngineError(
                    "An aim names the shaft {shaft}, but there are only {count} shafts.",
                    shaft=aim.shaft,
                    count=count,
                )
            if not aim.max_force > 0:
                raise EngineError(
                    "The force of an aim must be positive, not {force:g}.", force=aim.max_force
                )
        if not aims:
            return None
        shafts, places, targets, forces = zip(*aims, strict=True)
        return cls(
            readonly(np.array(shafts, np.intp)),
            readonly(np.array(places, np.complex128)),
            readonly(np.array(targets, np.complex128)),
            readonly(np.array(forces, np.float64)),
        )


class Motions(NamedTuple):
    """The best rigid motions of an armature's shafts (`engine.deform.forces.armature`).

    Parameters
    ----------
    offsets : complex128, shape (t,)
        f̂ of all points.
    means, correlations, turns : complex128, shape (s,)
        Mean of f, q and u of each shaft.
    """

    offsets: Complexes
    means: Complexes
    correlations: Complexes
    turns: Complexes
