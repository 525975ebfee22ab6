"""From the mask of a subject to its outline, a polygon of few edges, and the cage around it."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.spatial import cKDTree

from engine.arrays import Booleans, Complexes, Floats, readonly
from engine.cage import offset_cage
from engine.crossings import self_crossings
from engine.curve import arc_lengths, at_arc_lengths, smooth
from engine.errors import EngineError
from engine.margin import DistanceField, MarginCurve, curve_at_margin, distance_field
from engine.parts import join_parts
from engine.polygon import as_xy, contains, edges
from engine.simplify import choose_vertices
from engine.working_grid import working_grid

Detail = Literal["coarse", "normal", "fine"]
MARGINS: dict[Detail, float] = {"coarse": 0.012, "normal": 0.006, "fine": 0.003}  # of the diagonal
LEAST_MARGIN = 0.8  # pixels of an enlarged subject: enough to straighten staircases
LEAST_OFFSET, MOST_OFFSET = (
    0.005,
    0.02,
)  # of the diagonal: between boundary spikes and bad conditioning
NARROWEST_GAP = 0.002  # of the diagonal: below, two cages have no room in a gap
MOST_VERTICES = 180  # aimed at, by widening the margin
WIDENING, MOST_WIDENED = 1.4, 2.0
MOST_DRAFTS = 6
LEAST_TOLD = 0.001  # of the subject's area
FEWEST_EDGES = 40
SHORTEST_EDGE, LONGEST_EDGE = 0.0012, 0.07  # of the diagonal
SPACING = 0.5  # of the local margin, between the points that may become vertices
LEASH, INNER, OUTER = 0.3, 0.5, 0.6  # of the local margin: smoothing; edges within, without
SMOOTHING = 4  # rounds
TIGHTENING = 0.6
MOST_TURN = np.radians(160)  # at a vertex: sharper spikes have no room for triangles or a cage
MOST_ATTEMPTS = 10


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outline:
    """The polygon around a subject, and the cage around that.

    Parameters
    ----------
    points : complex128, shape (n,)
        Simple, counter-clockwise, in pixels of the picture: origin at the lower left corner of
        the picture, y up.
    cage : complex128, shape (n,)
        Simple, counter-clockwise, strictly around the points, one vertex for each of them.
    notices : tuple of str
        What had to be done to the subject, in words.
    """

    points: Complexes
    cage: Complexes
    notices: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Draft:
    """An outline and its cage in cells, and the area enclosed where the outline met itself."""

    points: Complexes
    cage: Complexes
    enclosed: float


def trace_outline(mask: Booleans, *, detail: Detail) -> Outline:
    """Find the outline of a subject, and the cage around it.

    Parameters
    ----------
    mask : bool, shape (h, w)
        True on the subject, first row on top.
    detail : {"coarse", "normal", "fine"}
        How closely the outline follows: its margin is 1.2, 0.6 or 0.3 % of the diagonal of the
        subject's box, wider where it would take too many vertices, narrower between limbs.

    Returns
    -------
    Outline
        Around every pixel of the mask, except specks. No edge is shorter than 0.1 % of the
        diagonal or longer than 7 %.

    Raises
    ------
    EngineError
        If the subject falls into too many parts, or is too intricate for an outline.
    """
    grid = working_grid(mask)
    piece = join_parts(grid.mask, grid.diagonal)
    field = distance_field(piece.mask)
    wanted = max(MARGINS[detail] * grid.diagonal, LEAST_MARGIN * max(1.0, 1 / grid.cell))
    closing = narrowest = NARROWEST_GAP * grid.diagonal
    widening = 1.0
    best: _Draft | None = None
    for _ in range(MOST_DRAFTS):
        draft = _draft(field, margin=widening * wanted, closing=closing, diagonal=grid.diagonal)
        best = draft or best
        if draft is not None:
            if len(draft.points) <= MOST_VERTICES or widening == MOST_WIDENED:
                break
            widening = min(MOST_WIDENED, WIDENING * widening)
        closing *= 2
    if best is None:
        raise EngineError(
            "The subject is too intricate for an outline; choose another detail, or close its "
            "finest gaps in the picture."
        )
    notices = list(piece.notices)
    if closing > narrowest:
        notices.append(f"gaps narrower than {closing * grid.cell:.1f} pixels closed")
    if widening > 1:
        notices.append(f"margin widened {widening:.1f} times for an outline of few vertices")
    share = best.enclosed / np.count_nonzero(piece.mask)
    if share >= LEAST_TOLD:
        notices.append(f"the outline closes over gaps of {share:.1%} of the subject")
    return Outline(
        points=readonly(grid.to_picture(best.points)),
        cage=readonly(grid.to_picture(best.cage)),
        notices=tuple(notices),
    )


def _draft(
    field: DistanceField, *, margin: float, closing: float, diagonal: float
) -> _Draft | None:
    """Draw outline and cage at a margin; return None if the subject is too intricate for it."""
    offset = float(np.clip(margin, LEAST_OFFSET * diagonal, MOST_OFFSET * diagonal))
    curve = curve_at_margin(field, margin=margin, offset=offset, closing=closing, diagonal=diagonal)
    points = _polygon_around(field.boundary(), curve, diagonal)
    if points is None:
        return None
    try:
        cage = offset_cage(points, offset)
    except EngineError:
        return None
    return _Draft(points=points, cage=cage, enclosed=curve.enclosed)


def _polygon_around(corners: Complexes, curve: MarginCurve, diagonal: float) -> Complexes | None:
    """Return a simple polygon of few edges along the curve, around all corners.

    Where it crosses itself, turns back or leaves out a corner, it is drawn again, closer to the
    curve; None is returned if that does not help.
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
    sharp = np.abs(np.angle(along / np.roll(along, 1))) > MOST_TURN
    if sharp.any():
        return np.asarray(polygon[sharp])
    crossing = self_crossings(polygon).any(axis=1)
    if crossing.any():
        return np.concatenate([polygon[crossing], np.roll(polygon, -1)[crossing]])
    return corners[~contains(polygon, corners)]
