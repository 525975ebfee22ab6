"""From the mask of a subject to its outline, a polygon of few edges, and its cage."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from engine.arrays import Booleans, Complexes, Indices, readonly, require_word
from engine.domain.mask.grid import working_grid
from engine.domain.mask.parts import WholePiece, join_parts
from engine.domain.outline.cage import offset_cage
from engine.domain.outline.cuts import cut_region
from engine.domain.outline.fitting import Candidates, fit_polygon
from engine.domain.outline.holes import SMALLEST_HOLE, find_visible_holes, make_hole, trace_hole
from engine.domain.outline.margin import DistanceField, MarginCurve, curve_at_margin, distance_field
from engine.domain.outline.remedies import describe_curve, describe_filled_holes
from engine.errors import EngineError, Message
from engine.geometry import Hole, require_holes

Detail = Literal["coarse", "normal", "fine"]
Holes = Literal["keep", "fill"]
HOLES: tuple[Holes, ...] = get_args(Holes)
MARGINS: dict[Detail, float] = {"coarse": 0.012, "normal": 0.006, "fine": 0.003}  # of the diagonal
LEAST_MARGIN = 0.8  # pixels of an enlarged subject: enough to straighten staircases
# Of the diagonal: a closer cage causes spikes at the boundary, a farther one bad conditioning.
LEAST_OFFSET, MOST_OFFSET = 0.005, 0.02
NARROWEST_GAP = 0.002  # of the diagonal: a narrower gap has no room for two cages
# Vertices to aim at. If an outline needs more, its margin is widened; if that fails, gaps are
# closed, wider ones each time.
MOST_VERTICES = 200
# Most vertices of an outline: the cost of a map grows with their square.
LARGEST_OUTLINE = 500
WIDEST_GAP = 0.2  # of the diagonal: widest gap that is closed to save vertices
WIDENING, MOST_WIDENED = 1.42, 2.0
MOST_DRAFTS = 6
DISC = 2.5  # area of a disc of radius 1, with some room for pixels


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Enclosure:
    """The outline of a subject and its cage, and those of its holes.

    Parameters
    ----------
    outline : complex128, shape (n,)
        Simple, counter-clockwise, in pixels of the picture: origin at the lower left corner of the
        picture, y up.
    cage : complex128, shape (n,)
        Simple, counter-clockwise, strictly around the outline, one vertex for each of its own.
    holes : tuple of Hole
        Inside the outline and apart, the largest first.
    notices : tuple of Message
        Every remedy that was applied.
    closed : complex128, shape (m,), optional
        Painted places of the vertices of the outline, and then of the holes' outlines: both sides
        of a slit meet. None without slits.
    """

    outline: Complexes
    cage: Complexes
    holes: tuple[Hole, ...]
    notices: tuple[Message, ...]
    closed: Complexes | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Draft:
    """A curve for an outline, in cells, with the remedies behind it."""

    curve: MarginCurve
    candidates: Candidates
    offset: float  # from outline to cage, in cells
    widening: float  # of the margin
    closing: float  # cells: narrower gaps were closed


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Fit:
    """An outline and its cage in cells, fitted to a draft."""

    outline: Complexes
    cage: Complexes
    draft: _Draft


def enclose_subject(
    mask: Booleans,
    *,
    detail: Detail,
    holes: Holes = "keep",
    swapped: npt.ArrayLike = (),
    slits: Sequence[Complexes] = (),
) -> Enclosure:
    """Find the outline of a subject, and its cage.

    Parameters
    ----------
    mask : bool, shape (h, w)
        True on the subject, first row on top.
    detail : {"coarse", "normal", "fine"}
        Margin of the outline: 1.2, 0.6 or 0.3 % of the diagonal of the subject's box, wider where
        it would take too many vertices, narrower between limbs.
    holes : {"keep", "fill"}
        Whether large holes stay holes. A disc of 2.4 % of the diagonal must fit into them. The
        largest come first, as long as all loops together have few vertices.
    swapped : array_like of complex
        Points in holes that are treated the other way, in pixels of the picture, y up.
    slits : sequence of complex128, each of shape (n,)
        Lines along which the subject is cut, in pixels of the picture, y up.

    Returns
    -------
    Enclosure
        Around every pixel of the mask, except specks. No edge of the outline is shorter than 0.1 %
        of the diagonal or longer than 7 %.

    Raises
    ------
    EngineError
        If the subject has too many separate parts, or is too intricate for an outline; if a slit
        cuts off a part of it, or separates nothing.
    """
    require_word(detail, MARGINS, "The detail")
    require_word(holes, HOLES, "The treatment of holes")
    grid = working_grid(mask)
    piece = join_parts(grid.mask, grid.diagonal)
    margin = max(MARGINS[detail] * grid.diagonal, LEAST_MARGIN * max(1.0, 1 / grid.cell))
    fit = _best_fit(distance_field(piece.mask), margin, grid.diagonal)
    others = piece.numbers_at(grid.to_cells(np.asarray(swapped, dtype=np.complex128)))
    every = np.arange(1, len(piece.hole_areas) + 1)
    wanted = np.setdiff1d(every, others) if holes == "keep" else np.intersect1d(every, others)
    kept, crowded = _kept_holes(piece, wanted, fit, margin, grid.diagonal)
    seen = find_visible_holes(piece, grid)
    small = np.intersect1d(np.setdiff1d(wanted, [*kept, *crowded]), seen)
    filled = np.intersect1d(np.setdiff1d(every, wanted), seen)
    closed = None
    outline, cage, open_holes = fit.outline, fit.cage, tuple(kept.values())
    if slits:
        lines = [grid.to_cells(slit) for slit in slits]
        outline, cage, open_holes, closed = _cut_loops(
            fit, open_holes, lines, grid.mask, grid.diagonal
        )
    return Enclosure(
        outline=readonly(grid.to_picture(outline)),
        cage=readonly(grid.to_picture(cage)),
        holes=tuple(hole.moved(grid.origin, grid.cell) for hole in open_holes),
        closed=None if closed is None else readonly(grid.to_picture(closed)),
        notices=(
            *piece.notices,
            *describe_filled_holes(piece, filled, small, crowded),
            *describe_curve(fit.draft.curve, fit.draft.widening, int(np.count_nonzero(piece.mask))),
        ),
    )


def _cut_loops(
    fit: _Fit,
    holes: Sequence[Hole],
    lines: Sequence[Complexes],
    mask: Booleans,
    diagonal: float,
) -> tuple[Complexes, Complexes, tuple[Hole, ...], Complexes]:
    """Cut an outline and its holes; return both with cages, and their painted places."""
    loops, closed = cut_region(
        [fit.outline, *(hole.outline for hole in holes)], lines, mask, diagonal
    )
    untouched = {hole.outline.tobytes(): hole for hole in holes}
    offset = fit.draft.offset
    try:
        cage = offset_cage(loops[0], offset)
        found = tuple(
            untouched.get(loop.tobytes()) or make_hole(loop, offset) for loop in loops[1:]
        )
    except EngineError as error:
        raise EngineError(
            "The knife's line leaves too little room beside it; draw it farther from edges and "
            "other lines."
        ) from error
    if sum(map(len, loops)) > LARGEST_OUTLINE:
        raise EngineError("The knife has too many lines; draw fewer or shorter lines.")
    return loops[0], cage, found, np.concatenate(closed)


def _kept_holes(
    piece: WholePiece, wanted: Indices, fit: _Fit, margin: float, diagonal: float
) -> tuple[dict[int, Hole], list[int]]:
    """Trace the wanted holes that are large enough, as long as vertices are left.

    Return holes by their numbers, and the numbers of the holes without vertices.
    """
    kept: dict[int, Hole] = {}
    room = MOST_VERTICES - len(fit.outline)
    crowded: list[int] = []
    # No disc of the least width fits into a smaller hole; pictures may have thousands of them.
    least = DISC * (SMALLEST_HOLE * diagonal) ** 2
    for number in map(int, wanted[piece.hole_areas[wanted - 1] >= least]):
        hole = trace_hole(
            piece.holes,
            number,
            margin=margin * fit.draft.widening,
            offset=fit.draft.offset,
            closing=NARROWEST_GAP * diagonal,
            diagonal=diagonal,
        )
        if hole is None:
            continue
        if len(hole.outline) > room:
            crowded.append(number)
            continue
        try:
            require_holes([*(other.outline for other in kept.values()), hole.outline], fit.outline)
        except EngineError:
            continue
        kept[number] = hole
        room -= len(hole.outline)
    return kept, crowded


def _best_fit(field: DistanceField, margin: float, diagonal: float) -> _Fit:
    """Return the first outline of few vertices, or else the acceptable one with fewest.

    The margin is widened while there are too many vertices. If that is not enough, or no outline or
    cage fits, wider gaps are closed. A draft that few vertices cannot follow is fitted only if
    every other fails.
    """
    widening, closing = 1.0, NARROWEST_GAP * diagonal
    corners = field.boundary()
    fits: list[_Fit] = []
    intricate: list[_Draft] = []
    for _ in range(MOST_DRAFTS):
        draft = _draft(field, margin, diagonal, widening=widening, closing=closing)
        is_intricate = draft.candidates.fewest_edges > MOST_VERTICES
        if is_intricate:
            intricate.append(draft)
        fit = None if is_intricate else _fit(draft, corners)
        if fit is not None:
            if len(fit.outline) <= MOST_VERTICES:
                return fit
            fits.append(fit)
        if (is_intricate or fit is not None) and widening < MOST_WIDENED:
            widening = min(MOST_WIDENED, WIDENING * widening)
        else:
            closing *= 2
    intricate.sort(key=lambda draft: draft.candidates.fewest_edges)
    while not fits and intricate:
        fit = _fit(intricate.pop(0), corners)
        fits += [] if fit is None else [fit]
    while min((len(fit.outline) for fit in fits), default=np.inf) > LARGEST_OUTLINE:
        if closing > WIDEST_GAP * diagonal:
            raise EngineError(
                "The subject is too intricate for an outline. Choose another detail, or close "
                "the finest gaps in the picture."
            )
        fit = _fit(_draft(field, margin, diagonal, widening=widening, closing=closing), corners)
        fits += [] if fit is None else [fit]
        closing *= 2
    return min(fits, key=lambda fit: len(fit.outline))


def _draft(
    field: DistanceField, margin: float, diagonal: float, *, widening: float, closing: float
) -> _Draft:
    """Draft the curve that an outline follows."""
    margin *= widening
    offset = float(np.clip(margin, LEAST_OFFSET * diagonal, MOST_OFFSET * diagonal))
    curve = curve_at_margin(field, margin=margin, offset=offset, closing=closing, diagonal=diagonal)
    return _Draft(
        curve=curve,
        candidates=Candidates.on(curve, diagonal),
        offset=offset,
        widening=widening,
        closing=closing,
    )


def _fit(draft: _Draft, corners: Complexes) -> _Fit | None:
    """Fit outline and cage to a draft; return None if the subject is too intricate."""
    outline = fit_polygon(draft.candidates, corners)
    if outline is None:
        return None
    try:
        return _Fit(outline=outline, cage=offset_cage(outline, draft.offset), draft=draft)
    except EngineError:
        return None
