"""A polygon of few edges along a curve that keeps a margin around a mask."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import shapely
from scipy.spatial import cKDTree

from engine.arrays import Complexes, Floats
from engine.domain.outline.crossings import find_crossing_edges
from engine.domain.outline.curve import arc_lengths, points_at_arc_lengths, smooth_curve
from engine.domain.outline.margin import MarginCurve
from engine.domain.outline.simplify import LONGEST_SPAN, choose_vertices
from engine.geometry import as_xy, contains, edge_vectors, shapely_region, signed_area

FEWEST_EDGES = 40
SHORTEST_EDGE, LONGEST_EDGE = 0.0012, 0.07  # of the diagonal
SPACING = 0.5  # of the local margin, between the points that may become vertices
MAX_SHIFT, INNER, OUTER = 0.3, 0.5, 0.6  # of the local margin: smoothing; edges within, without
SMOOTHING = 4  # rounds
TIGHTENING = 0.6
MOST_TURN = 160.0  # degrees, at a vertex: sharper spikes have no room for triangles or a cage
MOST_ATTEMPTS = 10


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Candidates:
    """Points of a curve that may become vertices of a polygon.

    Parameters
    ----------
    points : complex128, shape (n,)
        In order along the curve, closer where its margin is small.
    shortest, longest : float
        Lengths of an edge of the polygon.
    """

    points: Complexes
    margins: Floats
    shortest: float
    longest: float

    @classmethod
    def on(cls, curve: MarginCurve, diagonal: float, *, fewest_edges: int = FEWEST_EDGES) -> Self:
        """Choose points on a curve along a subject whose box has this diagonal."""
        shortest = SHORTEST_EDGE * diagonal
        points, margins = _graded(curve, shortest)
        longest = min(
            LONGEST_EDGE * diagonal, float(np.abs(edge_vectors(points)).sum()) / fewest_edges
        )
        return cls(points=points, margins=margins, shortest=shortest, longest=longest)

    @property
    def fewest_edges(self) -> int:
        """The least number of edges of a polygon with edges of these lengths along the curve."""
        return -(-len(self.points) // LONGEST_SPAN)


def fit_polygon(candidates: Candidates, corners: Complexes) -> Complexes | None:
    """Fit a simple polygon of few edges (p,) to a curve that has `corners` (c,) on its left.

    If the polygon crosses itself, turns back or leaves out a corner, it is fitted again, closer to
    the curve. Returns it in the direction of the curve; None if that does not help.
    """
    points, margins = candidates.points, candidates.margins
    slack = np.ones(len(points))
    for _ in range(MOST_ATTEMPTS):
        smoothed = smooth_curve(points, MAX_SHIFT * slack * margins, SMOOTHING)
        chosen = choose_vertices(
            smoothed,
            INNER * slack * margins,
            OUTER * slack * margins,
            shortest=candidates.shortest,
            longest=candidates.longest,
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
    return points_at_arc_lengths(curve.points, wanted), margins


def _faults(polygon: Complexes, corners: Complexes) -> Complexes:
    """Return the places where a polygon crosses itself, turns back or leaves out a corner."""
    along = edge_vectors(polygon)
    sharp = np.abs(np.angle(along / np.roll(along, 1))) > np.radians(MOST_TURN)
    crossing = find_crossing_edges(polygon)
    crossing |= np.roll(crossing, 1)  # the vertices at both ends of such an edge
    if crossing.any() or sharp.any():
        return np.asarray(polygon[crossing | sharp])
    if signed_area(polygon) > 0:
        return corners[~contains(polygon, corners)]
    hole = shapely_region(polygon)
    shapely.prepare(hole)
    return np.asarray(corners[shapely.contains_xy(hole, corners.real, corners.imag)])
