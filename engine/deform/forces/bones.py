"""What an armature is made of: shafts, hinges and aims; and how its shafts move."""

from collections.abc import Sequence
from math import inf
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats, Indices, readonly
from engine.errors import EngineError

# κ L² of a shaft.
SHAFT_STIFFNESS = 1e6
# A shaft of fewer points has no direction.
FEWEST_POINTS = 2


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
    weights : float or float64, shape (m,)
        Shares of κ.
    """

    points: Complexes
    rest: Complexes
    stiffness: float = SHAFT_STIFFNESS
    weights: Floats | float = 1.0


class Hinge(NamedTuple):
    """A place that two shafts, by their numbers, have in common, in the rest of each."""

    first: int
    second: int
    first_place: complex
    second_place: complex


class Aim(NamedTuple):
    """A target of a place in the rest of a shaft, or of a way there.

    `max_force` is its largest force, per L, and `weight` a factor of its stiffness. A way turns
    with the shaft and is nowhere: its aim turns the shaft and moves it nowhere.
    """

    shaft: int
    place: complex
    target: complex
    max_force: float = inf
    weight: float = 1.0
    is_way: bool = False


class Aims(NamedTuple):
    """Several aims, as arrays (a,)."""

    shafts: Indices
    places: Complexes
    targets: Complexes
    max_forces: Floats
    weights: Floats
    are_places: Floats  # 1 for places, 0 for ways

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
        shafts, places, targets, forces, weights, are_ways = zip(*aims, strict=True)
        return cls(
            readonly(np.array(shafts, np.intp)),
            readonly(np.array(places, np.complex128)),
            readonly(np.array(targets, np.complex128)),
            readonly(np.array(forces, np.float64)),
            readonly(np.array(weights, np.float64)),
            readonly(1.0 - np.array(are_ways, np.float64)),
        )


class Motions(NamedTuple):
    """The best rigid motions of shafts (`engine.deform.forces.rigid_shafts`).

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


def require_armature(shafts: Sequence[Shaft], hinges: Sequence[Hinge]) -> None:
    """Raise an `EngineError` unless shafts have a direction and hinges name shafts that exist."""
    for number, shaft in enumerate(shafts):
        if len(shaft.points) < FEWEST_POINTS or not np.ptp(shaft.rest) != 0:
            raise EngineError("Shaft {number} needs two different points.", number=number)
    for hinge in hinges:
        if not {hinge.first, hinge.second} <= set(range(len(shafts))):
            raise EngineError(
                "A hinge joins shafts {first} and {second}, but there are only {count}.",
                first=hinge.first,
                second=hinge.second,
                count=len(shafts),
            )
