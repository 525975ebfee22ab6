"""Transfer of stiffness from one outline to another by position."""

from collections.abc import Sequence

import numpy as np
import shapely

from engine.arrays import Complexes, Floats, as_reals
from engine.errors import EngineError
from engine.geometry import as_xy, diameter, loop_ends, next_on_loop

# Of the old outline's diameter: beyond this distance no stiffness is transferred, and from half of
# it on less.
FAR = 0.06
NO_STIFFNESS = (
    "stiffness must be {count} finite numbers above 0, one for each vertex, not {stiffness}."
)


def copy_nearest_stiffness(
    loops: Sequence[Complexes], stiffness: Floats, points: Complexes
) -> Floats:
    """Return the stiffness of the nearest places of an outline at points (t,), 1 far from it.

    Parameters
    ----------
    loops : sequence of complex128
        The old outline, and those of its holes.
    stiffness : float64, shape (p,)
        At their vertices; logarithmically linear along their edges.
    points : complex128, shape (t,)
        For example the vertices of the new outline.
    """
    corners, ends = np.concatenate(loops), loop_ends(loops)
    stiffness = as_reals(stiffness, "stiffness")
    if stiffness.shape != corners.shape or not ((stiffness > 0) & np.isfinite(stiffness)).all():
        raise EngineError(NO_STIFFNESS, count=len(corners), stiffness=stiffness)
    starts = np.cumsum([0, *map(len, loops[:-1])])
    following = next_on_loop(starts, len(corners))
    both = np.column_stack([corners, ends])
    nearest = shapely.STRtree(shapely.linestrings(both.real, both.imag)).nearest(
        shapely.points(as_xy(points))
    )
    sides = ends[nearest] - corners[nearest]
    along = np.clip(((points - corners[nearest]) / sides).real, 0.0, 1.0)
    distances = np.abs(points - corners[nearest] - along * sides)
    logarithms = np.log(stiffness)
    there = (1 - along) * logarithms[nearest] + along * logarithms[following[nearest]]
    share = np.clip(2 - 2 * distances / (FAR * diameter(loops[0])), 0.0, 1.0)
    carried: Floats = np.exp(share * there)
    return carried
