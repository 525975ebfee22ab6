"""The kept holes of a subject: an outline around each, and a cage inside it.

A hole is outlined by the same rules as the subject, seen from the subject. Its loop runs clockwise,
so that the subject lies on the left, and margin and offset lead into the hole. They shrink with the
hole, so that outline and cage leave its middle free.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from engine.arrays import Booleans, Complexes, Indices, Integers
from engine.domain.mask.grid import WorkingGrid, working_grid
from engine.domain.mask.parts import WholePiece, join_parts
from engine.domain.outline.cage import offset_cage
from engine.domain.outline.fitting import Candidates, fit_polygon
from engine.domain.outline.margin import curve_at_margin, distance_field
from engine.errors import EngineError
from engine.geometry import Hole, deepest_point

# Least radii of the largest disc, over the diagonal: in a kept hole, and in an enclosed part of the
# background's colour. Such a part is removed or kept although the mesh has no hole there.
SMALLEST_HOLE, SMALLEST_POCKET = 0.012, 0.003
BUBBLE = 3.0  # pixels: least radius of a visible part inside a soft contour
SHARE = 0.25  # of this radius: largest margin, and largest offset from outline to cage
FEWEST_EDGES = 16
FRAME = 2  # cells of the subject around a hole that is cut out


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HoleMap:
    """The holes of a subject, in pixels of its picture, y up.

    Parameters
    ----------
    piece : WholePiece
        In cells of the grid.
    middles : dict of int to complex
        Middles by number of the holes that are large enough to be kept or removed.
    shut : frozenset of int
        Of these, the ones that belong to the subject by default.
    """

    grid: WorkingGrid
    piece: WholePiece
    middles: Mapping[int, complex]
    shut: frozenset[int]

    def number_at(self, point: complex) -> int:
        """Return the number of the hole with this point, if it has a middle; else 0."""
        numbers = self.piece.numbers_at(self.grid.to_cells(np.array([point])))
        return int(numbers[0]) if len(numbers) and int(numbers[0]) in self.middles else 0


def find_holes(mask: Booleans, enclosed: Booleans | None = None, *, opens: bool = False) -> HoleMap:
    """Find the holes of a subject, and its possible holes.

    Parameters
    ----------
    mask : bool, shape (h, w)
        True on the subject, first row on top.
    enclosed : bool, shape (h, w), optional
        True on inner parts that could be holes, whether or not they are in the mask.
    opens : bool
        Whether these parts are holes by default.

    Raises
    ------
    EngineError
        If the subject has too many separate parts.
    """
    if enclosed is not None:
        mask = mask & ~enclosed
    grid = working_grid(mask)
    piece = join_parts(grid.mask, grid.diagonal)
    middles, shut = {}, set()
    windows = ndimage.find_objects(piece.holes)
    for number, (rows, columns) in enumerate(windows, start=1):
        depth = ndimage.distance_transform_edt(np.pad(piece.holes[rows, columns] == number, 1))
        row, column = np.unravel_index(int(np.argmax(depth)), depth.shape)
        radius = depth[row, column] / grid.diagonal
        if radius < SMALLEST_POCKET:
            continue
        cell = complex(columns.start + column - 0.5, rows.start + row - 0.5)
        middle = complex(grid.to_picture(np.array([cell]))[0])
        pixel = int(len(mask) - middle.imag), int(middle.real)
        is_pocket = enclosed is not None and bool(enclosed[pixel])
        if is_pocket or radius >= SMALLEST_HOLE:
            middles[number] = middle
        if is_pocket and not opens:
            shut.add(number)
    return HoleMap(grid=grid, piece=piece, middles=middles, shut=frozenset(shut))


def find_visible_holes(piece: WholePiece, grid: WorkingGrid) -> Indices:
    """Return the numbers of visible holes, without bubbles in a soft contour."""
    least = max(SMALLEST_POCKET * grid.diagonal, BUBBLE / grid.cell)
    seen = []
    for number, (rows, columns) in enumerate(ndimage.find_objects(piece.holes), start=1):
        hole = np.pad(piece.holes[rows, columns] == number, 1)
        if min(hole.shape) >= 2 * least and ndimage.distance_transform_edt(hole).max() >= least:
            seen.append(number)
    return np.array(seen, dtype=np.intp)


def trace_hole(
    labels: Integers, number: int, *, margin: float, offset: float, closing: float, diagonal: float
) -> Hole | None:
    """Find the outline of a hole, and the cage inside it, in cells.

    Parameters
    ----------
    labels : int32, shape (h, w)
        The number of each cell's hole, 0 without one.
    number : int
        Of the hole.
    margin, offset : float
        Wanted distances from the subject to the outline and from there to the cage, in cells.
    closing : float
        Width, in cells, below which a gap within the hole is closed.
    diagonal : float
        Of the subject's box, in cells.

    Returns
    -------
    Hole or None
        None if the hole is too small, or too intricate.
    """
    rows, columns = ndimage.find_objects(labels, max_label=number)[number - 1]
    window: Booleans = np.pad(labels[rows, columns] == number, FRAME)
    corner = complex(columns.start - FRAME, rows.start - FRAME)
    field = distance_field(~window)
    radius = float(field.distance.max())
    if radius < SMALLEST_HOLE * diagonal:
        return None
    offset = min(offset, SHARE * radius)
    curve = curve_at_margin(
        field,
        margin=min(margin, SHARE * radius),
        offset=offset,
        closing=closing,
        diagonal=float(np.hypot(*window.shape)),
        hole=True,
    )
    candidates = Candidates.on(curve, diagonal, fewest_edges=FEWEST_EDGES)
    outline = fit_polygon(candidates, field.boundary())
    if outline is None:
        return None
    try:
        return make_hole(outline, offset).moved(corner)
    except EngineError:
        return None


def make_hole(outline: Complexes, offset: float) -> Hole:
    """Return the hole with this outline, and a cage in it with at most this offset.

    Raises
    ------
    EngineError
        If the outline comes too close to itself to leave room for a cage.
    """
    cage = offset_cage(outline, offset, hole=True)
    return Hole(outline=outline, cage=cage, centre=deepest_point(cage))
