"""A polygon of few edges along a curve that keeps a margin around a mask."""

import numpy as np
from scipy.spatial import cKDTree

from engine.arrays import Complexes, Floats
from engine.domain.outline.crossings import self_crossings
from engine.domain.outline.curve import arc_lengths, at_arc_lengths, smooth
from engine.domain.outline.margin import MarginCurve
from engine.domain.outline.simplify import choose_vertices
from engine.geometry import as_xy, contains, edges

FEWEST_EDGES = 40
SHORTEST_EDGE, LONGEST_EDGE = 0.0012, 0.07  # of the diagonal
SPACING = 0.5  # of the local margin, between the points that may become vertices
LEASH, INNER, OUTER = 0.3, 0.5, 0.6  # of the local margin: smoothing; edges within, without
SMOOTHING = 4  # rounds
TIGHTENING = 0.6
MOST_TURN = 160.0  # degrees, at a vertex: sharper spikes have no room for triangles or a cage
MOST_ATTEMPTS = 10


def fit_polygon(curve: MarginCurve, corners: Complexes, diagonal: float) -> Complexes | None:
    """Fit a simple polygon of few edges to a curve around `corners`.

    Where it crosses itself, turns back or leaves out a corner, it is fitted again, closer to the
    curve.

    Parameters
    ----------
    curve : MarginCurve
    corners : complex128, shape (c,)
        Points that must lie inside.
    diagonal : float
        Of the subject's box: its edges are 0.12 to 7 % of it long.

    Returns
    -------
    complex128, shape (p,), or None
        Counter-clockwise; None if that does not help.
    """
    points, margins = _graded(curve, SHORTEST_EDGE * diagonal)
    longest = min(LONGEST_EDGE * diagonal, float(np.abs(edges(points)).sum()) / FEWEST_EDGES)
    slack = np.ones(len(points))
    for _ in range(MOST_ATTEMPTS):
        smoothed = smooth(points, LEASH * slack * margins, SMOOTHING)
        chosen = choose_vertices(
            smoothed,
            INNER * slack * margins,
            OUTER * slack * margins,
            shortest=SHORTEST_EDGE * diagonal,
            longest=longest,
        )
        polygon = smoothed[chosen]
        faults = _faults(polygon, corners)
        if not len(faults):
            return polygon
        distance, _ = cKDTree(as_xy(faults)).query(as_xy(points))
        slack[distance < 3 * margins] *= TIGHTENING
    return None


def _graded(curve: MarginCurve, shortest: float) -> tuple[Complexes, Floats]:
    """Return points along the curve, closer where the margin is small, and their margins."""
    arcs = arc_lengths(curve.points)
    spacing = np.maximum(SPACING * curve.margins, 0.5 * shortest)
    # Equal steps of the integral of 1 / spacing.
    density = np.diff(arcs) / spacing
    places = np.concatenate([[0.0], np.cumsum(density)])
    count = max(3 * 8, int(places[-1]))
    wanted = np.interp(places[-1] * np.arange(count) / count, places, arcs)
    margins = np.interp(wanted, arcs, np.append(curve.margins, curve.margins[0]))
    return at_arc_lengths(curve.points, wanted), margins


def _faults(polygon: Complexes, corners: Complexes) -> Complexes:
    """Return the places where a polygon crosses itself, turns back or leaves out a corner."""
    along = edges(polygon)
    sharp = np.abs(np.angle(along / np.roll(along, 1))) > np.radians(MOST_TURN)
    crossing = self_crossings(polygon).any(axis=1)
    crossing |= np.roll(crossing, 1)  # the vertices at both ends of such an edge
    if crossing.any() or sharp.any():
        return np.asarray(polygon[crossing | sharp])
    return corners[~contains(polygon, corners)]
