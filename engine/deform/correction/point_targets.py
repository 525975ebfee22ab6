"""Targets of the points of a correction."""

from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats, as_points
from engine.errors import EngineError

BAD_TARGETS = "The {name} of targets cannot be {values} for {count} points."


class PointTargets(NamedTuple):
    """Targets of points.

    Parameters
    ----------
    offsets : complex128, shape (m,)
        From the base's positions to the targets.
    weights : float64, shape (m,)
        From 0, free, to 1, held.
    is_anchored : bool
        Whether the anchor stays where it is.
    yield_forces : float64, shape (m,), optional
        Pull on each point at which the target error is the diameter. The target error grows with
        the cube of the pull, so that the point slows down smoothly where limits stop it. Without,
        or with infinity, targets are met.
    rotations : float64, shape (m,), optional
        Prescribed rotation of the shape at each point, in radians; NaN where it is free.
    compliances : float64, shape (m,), optional
        Target error over pull, added to the compliance of the weights.
    """

    offsets: Complexes
    weights: Floats
    is_anchored: bool
    yield_forces: Floats | None = None
    rotations: Floats | None = None
    compliances: Floats | None = None


def require_targets(targets: PointTargets, count: int) -> None:
    """Raise `EngineError` unless the targets are for `count` points and in range."""
    as_points(targets.offsets, "The moves of targets")
    for name, values, fits in (
        ("moves", targets.offsets, True),
        ("weights", targets.weights, (targets.weights >= 0) & (targets.weights <= 1)),
        ("forces", targets.yield_forces, targets.yield_forces is None or targets.yield_forces > 0),
        ("turns", targets.rotations, targets.rotations is None or ~np.isinf(targets.rotations)),
        ("give", targets.compliances, targets.compliances is None or targets.compliances >= 0),
    ):
        if values is not None and (len(values) != count or not np.all(fits)):
            raise EngineError(BAD_TARGETS, name=name, count=count, values=values)
