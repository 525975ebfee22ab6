"""From the mask of a subject to its outline, a polygon of few edges, and the cage around it."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from engine.arrays import Booleans, Complexes, readonly
from engine.domain.outline.cage import offset_cage
from engine.domain.outline.fitting import fit_polygon
from engine.domain.outline.margin import DistanceField, curve_at_margin, distance_field
from engine.domain.picture import WorkingGrid, join_parts, working_grid
from engine.errors import EngineError

Detail = Literal["coarse", "normal", "fine"]
MARGINS: dict[Detail, float] = {"coarse": 0.012, "normal": 0.006, "fine": 0.003}  # of the diagonal
LEAST_MARGIN = 0.8  # pixels of an enlarged subject: enough to straighten staircases
# Of the diagonal: a cage that is closer makes boundary spikes, a farther one bad conditioning.
LEAST_OFFSET, MOST_OFFSET = 0.005, 0.02
NARROWEST_GAP = 0.002  # of the diagonal: below, two cages have no room in a gap
MOST_VERTICES = 200  # aimed at: first the margin is widened for it, then gaps are closed
WIDENING, MOST_WIDENED = 1.42, 2.0
MOST_DRAFTS = 6
LEAST_TOLD = 0.001  # of the subject's area


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
    """An outline and its cage in cells, and what was done to get them."""

    points: Complexes
    cage: Complexes
    widening: float  # of the margin
    closing: float  # cells: width below which gaps were closed
    enclosed: float  # square cells: gaps that the outline closes over


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
    margin = max(MARGINS[detail] * grid.diagonal, LEAST_MARGIN * max(1.0, 1 / grid.cell))
    draft = _best_draft(distance_field(piece.mask), margin, grid.diagonal)
    return Outline(
        points=readonly(grid.to_picture(draft.points)),
        cage=readonly(grid.to_picture(draft.cage)),
        notices=piece.notices + _told(draft, grid, int(np.count_nonzero(piece.mask))),
    )


def _best_draft(field: DistanceField, margin: float, diagonal: float) -> _Draft:
    """Return the first draft of few vertices, or else the one of fewest.

    The margin is widened while there are too many vertices; wider gaps are closed where that is
    not enough, or where no outline or cage fits.
    """
    widening, closing = 1.0, NARROWEST_GAP * diagonal
    best: _Draft | None = None
    for _ in range(MOST_DRAFTS):
        draft = _draft(field, margin, diagonal, widening=widening, closing=closing)
        if draft is not None and (best is None or len(draft.points) < len(best.points)):
            best = draft
        if best is not None and len(best.points) <= MOST_VERTICES:
            break
        if draft is not None and widening < MOST_WIDENED:
            widening = min(MOST_WIDENED, WIDENING * widening)
        else:
            closing *= 2
    if best is None:
        raise EngineError(
            "The subject is too intricate for an outline; choose another detail, or close its "
            "finest gaps in the picture."
        )
    return best


def _told(draft: _Draft, grid: WorkingGrid, area: int) -> tuple[str, ...]:
    """Return notices of what a draft did to a subject of `area` cells."""
    notices = []
    if draft.closing > NARROWEST_GAP * grid.diagonal:
        notices.append(f"gaps narrower than {draft.closing * grid.cell:.1f} pixels closed")
    if draft.widening > 1:
        notices.append(f"margin widened {draft.widening:.1f} times for an outline of few vertices")
    share = draft.enclosed / area
    if share >= LEAST_TOLD:
        notices.append(f"the outline closes over gaps of {share:.1%} of the subject")
    return tuple(notices)


def _draft(
    field: DistanceField, margin: float, diagonal: float, *, widening: float, closing: float
) -> _Draft | None:
    """Draft outline and cage; return None where the subject is too intricate for them."""
    margin *= widening
    offset = float(np.clip(margin, LEAST_OFFSET * diagonal, MOST_OFFSET * diagonal))
    curve = curve_at_margin(field, margin=margin, offset=offset, closing=closing, diagonal=diagonal)
    points = fit_polygon(curve, field.boundary(), diagonal)
    if points is None:
        return None
    try:
        cage = offset_cage(points, offset)
    except EngineError:
        return None
    return _Draft(
        points=points, cage=cage, widening=widening, closing=closing, enclosed=curve.enclosed
    )
