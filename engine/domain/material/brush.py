"""Effect of a brush stroke on the vertices of the outline."""

from collections.abc import Sequence

import numpy as np
import shapely

from engine.arrays import Complexes, Floats, as_number, as_points
from engine.geometry import ON_OUTLINE, diameter, loop_ends, next_on_loop, shapely_region

TINY = 1e-9


def brush_weights(
    loops: Sequence[Complexes], places: Complexes, radius: float, softness: float
) -> Floats:
    """Return the effect of a stroke on the vertices of a drawing's loops, 0 to 1.

    A dab acts on the outline within its radius that is visible from its centre, so that it does not
    reach across a gap. Beside the drawing it acts on all of the outline within its radius. A dab on
    a long edge acts on the edge's ends, more on the nearer one.

    Parameters
    ----------
    loops : sequence of complex128
        The outline, and those of holes.
    places : complex128, shape (d,)
        The centres of the dabs.
    softness : float
        The part of the radius over which the effect falls to 0 at its edge, 0 to 1.

    Returns
    -------
    float64, shape (p,)
        All 0 if the stroke reaches no outline.
    """
    places = as_points(places, "The dabs of a stroke")
    radius = as_number(radius, "The radius of a brush", above=0)
    softness = as_number(softness, "The softness of a brush", least=0, most=1)
    corners, ends = np.concatenate(loops), loop_ends(loops)
    sides = ends - corners
    area = shapely_region(loops[0], loops[1:]).buffer(ON_OUTLINE * diameter(loops[0]))
    shapely.prepare(area)
    shares = np.zeros(len(corners))
    starts = np.cumsum([0, *map(len, loops[:-1])])
    following = next_on_loop(starts, len(corners))
    for place in places.tolist():
        along = np.clip(((place - corners) / sides).real, 0.0, 1.0)
        # The nearest outline gets the full effect, at any depth inside the brush.
        depth = min(float(np.abs(corners + along * sides - place).min()), radius)
        for part in (along, np.zeros(len(corners))):
            at = corners + part * sides
            away = (np.abs(at - place) - depth) / max(radius - depth, TINY * radius)
            strength = _falloff(away, softness)
            reached = np.flatnonzero(strength > 0)
            if shapely.intersects_xy(area, place.real, place.imag):
                lines = np.column_stack([np.full(len(reached), place), at[reached]])
                seen = shapely.covers(area, shapely.linestrings(lines.real, lines.imag))
                reached = reached[seen]
            strength, share = strength[reached], part[reached]
            np.maximum.at(shares, reached, strength * (1 - share))
            np.maximum.at(shares, following[reached], strength * share)
    return shares


def _falloff(distances: Floats, softness: float) -> Floats:
    """Return 1 inside, falling smoothly to 0 at distance 1."""
    if softness <= 0:
        return (distances <= 1).astype(np.float64)
    share = np.clip((1 - distances) / softness, 0.0, 1.0)
    falloff: Floats = share * share * (3 - 2 * share)
    return falloff
