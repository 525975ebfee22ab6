"""From the mask of a subject to its outline: a polygon of few edges around it."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.spatial import cKDTree

from engine.arrays import Booleans, Complexes, Floats, readonly
from engine.crossings import self_crossings
from engine.curve import arc_lengths, at_arc_lengths, smooth
from engine.errors import EngineError
from engine.margin import MarginCurve, curve_at_margin, distance_field
from engine.parts import join_parts
from engine.polygon import as_xy, contains, edges
from engine.simplify import choose_vertices
from engine.working_grid import working_grid

Detail = Literal["coarse", "normal", "fine"]
MARGINS: dict[Detail, float] = {"coarse": 0.012, "normal": 0.006, "fine": 0.003}  # of the diagonal
LEAST_MARGIN = 0.8  # pixels of an enlarged subject: enough to straighten staircases
WIDENINGS = (1.0, 1.4, 2.0)  # of the margin, until the outline has few vertices
MOST_VERTICES = 180  # aimed at
FEWEST_EDGES = 40
SHORTEST_EDGE, LONGEST_EDGE = 0.0012, 0.07  # of the diagonal
SPACING = 0.5  # of the local margin, between the points that may become vertices
LEASH, INNER, OUTER = 0.3, 0.5, 0.6  # of the local margin: smoothing; edges within, without
SMOOTHING = 4  # rounds
TIGHTENING = 0.6
MOST_ATTEMPTS = 12


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outline:
    """The polygon around a subject.

    Parameters
    ----------
    points : complex128, shape (p,)
        Simple, counter-clockwise, in pixels of the picture: origin at the lower left corner of
        the picture, y up.
    offset : float
        The distance, in pixels, at which the cage is to follow.
    notices : tuple of str
        What had to be done to the subject, in words.
    """

    points: Complexes
    offset: float
    notices: tuple[str, ...]


def trace_outline(mask: Booleans, *, detail: Detail) -> Outline:
    """Find the outline of a subject.

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
        Around every pixel of the mask, except specks; no edge shorter than 0.1 % of the diagonal.

    Raises
    ------
    EngineError
        If the subject falls into too many parts.
    """
    grid = working_grid(mask)
    piece = join_parts(grid.mask, grid.diagonal)
    field = distance_field(piece.mask)
    corners = _boundary_corners(piece.mask)
    least = LEAST_MARGIN * max(1.0, 1 / grid.cell)
    notices = list(piece.notices)
    wanted = max(MARGINS[detail] * grid.diagonal, least)
    for widening in WIDENINGS:
        margin = widening * wanted
        curve = curve_at_margin(field, margin=margin, offset=margin, diagonal=grid.diagonal)
        polygon = _polygon_around(corners, curve, grid.diagonal)
        if len(polygon) <= MOST_VERTICES:
            break
    if widening > 1:
        notices.append(f"margin widened {widening:g} times to keep the outline to few vertices")
    share = curve.enclosed / np.count_nonzero(piece.mask)
    if share >= 0.001:
        notices.append(f"narrow gap closed: it encloses {share:.1%} of the subject")
    return Outline(
        points=readonly(grid.to_picture(polygon)), offset=margin * grid.cell, notices=tuple(notices)
    )


def _boundary_corners(mask: Booleans) -> Complexes:
    """Return the corners of cells at which the mask and its surroundings meet."""
    padded = np.pad(mask, 1)
    around = padded[:-1, :-1].astype(np.uint8) + padded[:-1, 1:] + padded[1:, :-1] + padded[1:, 1:]
    rows, columns = np.nonzero((around > 0) & (around < 4))
    return columns + 1j * rows


def _polygon_around(corners: Complexes, curve: MarginCurve, diagonal: float) -> Complexes:
    """Return a simple polygon of few edges along the curve, around all corners.

    Where it crosses itself or leaves out a corner, it is drawn again, closer to the curve.
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
    raise EngineError(
        "No simple outline fits around the subject; choose another detail, or close fine gaps."
    )


def _graded(curve: MarginCurve, shortest: float) -> tuple[Complexes, Floats]:
    """Return points along the curve, closer where the margin is small, and their margins."""
    arcs = arc_lengths(curve.points)
    spacing = np.maximum(SPACING * curve.margins, 1.1 * shortest)
    # Equal steps of the integral of 1 / spacing.
    density = np.diff(arcs) / spacing
    places = np.concatenate([[0.0], np.cumsum(density)])
    count = max(3 * 8, int(places[-1]))
    wanted = np.interp(places[-1] * np.arange(count) / count, places, arcs)
    margins = np.interp(wanted, arcs, np.append(curve.margins, curve.margins[0]))
    return at_arc_lengths(curve.points, wanted), margins


def _faults(polygon: Complexes, corners: Complexes) -> Complexes:
    """Return the places where a polygon crosses itself or leaves out a corner."""
    crossing = self_crossings(polygon).any(axis=1)
    if crossing.any():
        return np.concatenate([polygon[crossing], np.roll(polygon, -1)[crossing]])
    return corners[~contains(polygon, corners)]
