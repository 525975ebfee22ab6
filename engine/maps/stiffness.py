"""Stiffness of a drawing: a factor of the energy's weights along its boundary.

The stiffness s is given at the vertices of the outline and of the holes' outlines, and is
logarithmically linear along the edges between them. The energy is a sum over samples of the
boundary, with weights times s. A harmonic map that is rigid on an open set is rigid everywhere:
stiff parts deform little, but never remain exactly rigid.
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats
from engine.errors import EngineError
from engine.geometry import arc_lengths

SOFTEST, STIFFEST = 1 / 30, 100.0
# Tolerance for rounding at the ends of the range.
ROUNDING = 1e-9
STIFFNESS_RANGE = (
    "stiffness must be from 1/30 to {stiffest:g}, not {value:g} as at vertex {vertex}; 1 is the "
    "default."
)
STIFFNESS_SHAPE = (
    "stiffness must be one number for each of the {count} vertices of the outline and the "
    "holes' outlines, not an array of shape {shape}, {dtype}."
)


def require_stiffness(stiffness: npt.ArrayLike, count: int) -> Floats:
    """Return the stiffness at the vertices of all loops, float64 (count,).

    Raises
    ------
    EngineError
        If there is another number of values, or a value is not a number from 1/30 to 100.
    """
    values = np.asarray(stiffness)
    if values.shape != (count,) or values.dtype.kind not in "biuf":
        raise EngineError(STIFFNESS_SHAPE, count=count, shape=values.shape, dtype=values.dtype)
    values = values.astype(np.float64)
    fits = (values >= SOFTEST * (1 - ROUNDING)) & (values <= STIFFEST * (1 + ROUNDING))
    if not fits.all():
        first = int(np.flatnonzero(~fits)[0])
        raise EngineError(STIFFNESS_RANGE, stiffest=STIFFEST, value=values[first], vertex=first)
    return values


def stiffness_along_loops(
    stiffness: Floats, loops: Sequence[Complexes], points: Sequence[Complexes]
) -> Floats:
    """Return the stiffness at points of the boundary.

    Parameters
    ----------
    stiffness : float64, shape (p,)
        At the vertices of the loops, one loop after the other.
    points : sequence of complex128
        On each loop in its order, from its first vertex on, with every vertex among them.
    """
    logarithms = np.split(np.log(stiffness), np.cumsum([len(loop) for loop in loops[:-1]]))
    return np.concatenate(
        [
            np.exp(np.interp(arc_lengths(its), arc_lengths(loop), values, period=_length(loop)))
            for loop, its, values in zip(loops, points, logarithms, strict=True)
        ]
    )


def _length(loop: Complexes) -> float:
    return float(np.abs(np.roll(loop, -1) - loop).sum())
