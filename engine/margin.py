"""The curve around a mask at a margin that shrinks where two limbs leave little room."""

from dataclasses import dataclass
from typing import cast

import contourpy
import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.curve import arc_lengths, limit_growth, outward_normals, resample
from engine.gaps import half_gaps
from engine.polygon import as_xy, signed_area

GAP_MARGIN = 0.42  # of half a gap, for the margin
GAP_ROOM = 0.75  # of half a gap, for margin and cage offset together
CLOSED_GAP = 0.00075  # of the diagonal: half gaps below this have no room for two cages
SEPARATION = 0.08  # of the diagonal: arc length from which on two points can face each other
SAMPLING = 0.0015  # of the diagonal: spacing at which gaps are looked for
GROWTH = 0.35  # by which the margin may grow along the curve, per arc length
CENTRE = 0.5 + 0.5j  # of a cell, where its distance is measured
SKIN = 0.25  # cells: margin of the curve on which gaps are looked for


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DistanceField:
    """Around a mask: how far each cell's centre is from the mask's cells, which are squares.

    Parameters
    ----------
    distance : float64, shape (h, w)
        -0.5 on the mask, 0.5 just beside it.
    rows, columns : int32, shape (h, w)
        The nearest cell of the mask.
    """

    distance: Floats
    rows: Indices
    columns: Indices


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MarginCurve:
    """A simple closed curve around a mask.

    Parameters
    ----------
    points : complex128, shape (n,)
        Counter-clockwise, in cells, about one cell apart.
    margins : float64, shape (n,)
        Distance from the mask, nearly.
    enclosed : float
        Area that the curve encloses because it closes on itself, in cells.
    """

    points: Complexes
    margins: Floats
    enclosed: float


def distance_field(mask: Booleans) -> DistanceField:
    """Measure the distances of all cells from the mask's squares."""
    centre, nearest = ndimage.distance_transform_edt(~mask, return_indices=True)
    rows, columns = nearest
    y, x = np.ogrid[: mask.shape[0], : mask.shape[1]]
    # The nearest centre need not belong to the nearest square, but it is never far from it.
    across = np.maximum(np.abs(rows - y) - 0.5, 0)
    along = np.maximum(np.abs(columns - x) - 0.5, 0)
    distance = np.where(centre > 0, np.hypot(across, along), -0.5)
    return DistanceField(distance=distance, rows=rows, columns=columns)


def curve_at_margin(
    field: DistanceField, *, margin: float, offset: float, diagonal: float
) -> MarginCurve:
    """Trace the curve at `margin` around a mask in one piece without holes.

    Where two limbs leave too little room for the margins and cage offsets of both, the margin
    shrinks, so that the limbs stay apart; where there is no room for two cages at all, the gap is
    closed.

    Parameters
    ----------
    field : DistanceField
    margin, offset : float
        Wanted distances from mask to curve and from curve to cage, in cells.
    diagonal : float
        Of the subject's box, in cells.
    """
    skin = resample(_outer_ring(field.distance - SKIN)[0], max(1.0, SAMPLING * diagonal))
    margins = _local_margins(skin, margin=margin, offset=offset, diagonal=diagonal)
    tree = cKDTree(as_xy(skin))
    if margins.min() < 0.999 * margin:
        ring, enclosed = _outer_ring(field.distance - _spread(field, tree, margins, margin))
    else:
        ring, enclosed = _outer_ring(field.distance - margin)
    _, nearest = tree.query(as_xy(ring))
    return MarginCurve(points=ring, margins=margins[nearest], enclosed=enclosed)


def _local_margins(skin: Complexes, *, margin: float, offset: float, diagonal: float) -> Floats:
    """Return the margin at each point of the mask's own outline."""
    reach = (margin + offset) / GAP_ROOM
    radius = half_gaps(
        skin, outward_normals(skin, 3), reach=reach, separation=SEPARATION * diagonal
    )
    share = min(GAP_MARGIN, GAP_ROOM * margin / (margin + offset))
    margins = np.minimum(margin, share * (radius + SKIN))
    closed = radius + SKIN < CLOSED_GAP * diagonal
    margins[closed] = margin
    graded = limit_growth(margins, arc_lengths(skin), GROWTH)
    return np.where(closed, margin, graded)


def _spread(field: DistanceField, tree: cKDTree, margins: Floats, margin: float) -> Floats:
    """Return for every cell the margin (h, w) at the mask's cell nearest to it."""
    spread = np.full(field.distance.shape, margin)
    near = (field.distance > 0) & (field.distance < margin + 2)
    rows, columns = field.rows[near], field.columns[near]
    # Each cell of the mask is looked up once.
    cells, members = np.unique(rows.astype(np.intp) * near.shape[1] + columns, return_inverse=True)
    y, x = np.divmod(cells, near.shape[1])
    _, nearest = tree.query(np.column_stack([x, y]) + 0.5)
    spread[y, x] = margins[nearest]
    spread[near] = margins[nearest][members.ravel()]
    return spread


def _outer_ring(values: Floats) -> tuple[Complexes, float]:
    """Trace the zero level; return its largest ring, counter-clockwise, and the area of holes."""
    # Separate polylines (the generator's default), each with its first point again at the end.
    lines = contourpy.contour_generator(z=values, name="serial").lines(0.0)
    rings = [
        line[:-1, 0] + 1j * line[:-1, 1] + CENTRE
        for line in cast("list[Floats]", lines)
        if len(line) > 3
    ]
    areas = np.array([signed_area(ring) for ring in rings])
    outer = int(np.abs(areas).argmax())
    # Rings within the outer one run the other way round.
    enclosed = float(np.abs(areas[areas * areas[outer] < 0]).sum())
    ring = rings[outer]
    return (ring if areas[outer] > 0 else ring[::-1]), enclosed
