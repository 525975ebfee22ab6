"""The curve around a mask at a margin, which shrinks between two close limbs."""

from dataclasses import dataclass
from typing import cast

import contourpy
import numpy as np
import shapely
from scipy import ndimage
from scipy.spatial import cKDTree

from engine.arrays import Booleans, Complexes, Floats, Integers
from engine.domain.outline.curve import arc_lengths, limit_growth, outward_normals, resample
from engine.domain.outline.gaps import half_gaps
from engine.geometry import as_xy, signed_area

GAP_ROOM = 0.75  # of half a gap, for margin and cage offset together
SEPARATION = 0.08  # of the diagonal: arc length from which on two points can face each other
SAMPLING = 0.0015  # of the diagonal: spacing of the search for gaps
GROWTH = 0.35  # largest growth of the margin along the curve, per arc length
NORMAL_REACH = 3  # samples before and after, over which normals are taken
CLOSED_GAP_WIDTH = 0.5  # of the width of closed gaps: the rest of a gap between the margins
MOST_SAMPLES = 10_000
SKETCH = 0.125  # of the margin: spacing that is always fine enough
DEEP = 3.0  # margins: the mask's outline is lost where it lies farther inside the curve
SKIN = 0.25  # cells: margin of the curve for the search for gaps


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DistanceField:
    """Distance of the nodes of a grid, the corners of its cells, from the cells of a mask.

    Parameters
    ----------
    distance : float64, shape (h + 1, w + 1)
        From node c + ir to the nearest point of the mask's squares: exact, because this point is a
        node itself.
    rows, columns : int32, shape (h + 1, w + 1)
        The nearest node of the mask.
    """

    distance: Floats
    rows: Integers
    columns: Integers

    def boundary(self) -> Complexes:
        """Return the mask's nodes, as points, with a neighbour outside."""
        inside = self.distance == 0
        inner = inside[:-2, 1:-1] & inside[2:, 1:-1] & inside[1:-1, :-2] & inside[1:-1, 2:]
        inside[1:-1, 1:-1] &= ~inner
        rows, columns = np.nonzero(inside)
        return np.asarray(columns + 1j * rows)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MarginCurve:
    """A simple closed curve along a mask on its left.

    Parameters
    ----------
    points : complex128, shape (n,)
        In cells, at most about one cell apart in bends: counter-clockwise around the mask,
        clockwise in a hole of it.
    margins : float64, shape (n,)
        Distance from the mask, nearly.
    enclosed : float
        Area of pockets that the curve encloses, or leaves out of a hole, because it closes on
        itself, in cells.
    skin : complex128, shape (s,)
        The mask's own outline.
    deep : float
        Distance from the curve from which a point of the skin is lost.
    """

    points: Complexes
    margins: Floats
    enclosed: float
    skin: Complexes
    deep: float

    def joined_gap_share(self) -> float:
        """Return the share of the skin far inside the curve, in gaps that were closed."""
        shell = shapely.LinearRing(as_xy(self.points))
        shapely.prepare(shell)
        followed = shapely.dwithin(shell, shapely.points(as_xy(self.skin)), self.deep)
        return 1 - float(np.mean(followed))


def distance_field(mask: Booleans) -> DistanceField:
    """Measure the distances of all nodes from a mask (h, w) of cells."""
    padded = np.pad(mask, 1)
    lower, upper = padded[:-1], padded[1:]
    nodes = lower[:, :-1] | lower[:, 1:] | upper[:, :-1] | upper[:, 1:]
    distance, (rows, columns) = ndimage.distance_transform_edt(~nodes, return_indices=True)
    return DistanceField(distance=distance, rows=rows, columns=columns)


def curve_at_margin(
    field: DistanceField,
    *,
    margin: float,
    offset: float,
    closing: float,
    diagonal: float,
    hole: bool = False,
) -> MarginCurve:
    """Trace the curve at `margin` around a mask in one piece without holes, or inside a hole.

    Where two limbs leave too little room for the margins and cage offsets of both, the margin
    shrinks, so that the limbs stay apart. Gaps narrower than `closing` are closed.

    Parameters
    ----------
    margin, offset : float
        Wanted distances from mask to curve and from curve to cage, in cells.
    closing : float
        Width, in cells, below which a gap is closed.
    diagonal : float
        Of the box of the subject or of the hole, in cells.
    hole : bool
        Whether the curve runs in the one hole of a mask that fills its frame.
    """
    skin, _ = _largest_ring(field.distance - SKIN, hole=hole)
    spacing = max(1.0, SAMPLING * diagonal, SKETCH * margin, arc_lengths(skin)[-1] / MOST_SAMPLES)
    skin = resample(skin, spacing)
    margins = _local_margins(
        skin, margin=margin, offset=offset, closing=closing, separation=SEPARATION * diagonal
    )
    tree = cKDTree(as_xy(skin))
    level = margin if np.allclose(margins, margin) else _spread(field, tree, margins, margin)
    ring, enclosed = _largest_ring(field.distance - level, hole=hole)
    ring, pockets = _without_slits(ring, CLOSED_GAP_WIDTH * closing)
    _, nearest = tree.query(as_xy(ring))
    enclosed += pockets
    return MarginCurve(
        points=ring, margins=margins[nearest], enclosed=enclosed, skin=skin, deep=DEEP * margin
    )


def _local_margins(
    skin: Complexes, *, margin: float, offset: float, closing: float, separation: float
) -> Floats:
    """Return the margin at each point of the mask's own outline."""
    enough = (margin + offset) / GAP_ROOM
    normals = outward_normals(skin, NORMAL_REACH)
    reach = max(enough, closing / 2)
    room = SKIN + half_gaps(skin, normals, reach=reach, separation=separation)
    closed = room < closing / 2
    margins = np.where(closed, margin, np.minimum(margin, room * margin / enough))
    margins = limit_growth(margins, arc_lengths(skin), GROWTH)
    # Both sides of a closed gap must meet, regardless of the margins beside it.
    margins[closed] = np.maximum(margin, room[closed] + 1)
    return margins


def _without_slits(ring: Complexes, width: float) -> tuple[Complexes, float]:
    """Close the slits on the right of a ring that are narrower than `width`, too narrow for edges.

    Return the ring and the area of the pockets that are enclosed, or cut off from a hole.
    """
    clockwise = signed_area(ring) < 0
    grow = -width / 2 if clockwise else width / 2
    area = shapely.Polygon(as_xy(ring))
    area = area.buffer(grow, quad_segs=2).buffer(-grow, quad_segs=2)
    parts = shapely.get_parts(area)
    largest = parts[shapely.area(parts).argmax()]
    filled = shapely.orient_polygons(shapely.Polygon(largest.exterior), exterior_cw=clockwise)
    xy = shapely.get_coordinates(filled)
    pockets = float(shapely.area(parts).sum() if clockwise else filled.area) - float(largest.area)
    return xy[:-1, 0] + 1j * xy[:-1, 1], pockets


def _spread(field: DistanceField, tree: cKDTree, margins: Floats, margin: float) -> Floats:
    """Return for every node the margin (h + 1, w + 1) at the mask's node nearest to it."""
    spread = np.full(field.distance.shape, margin)
    near = (field.distance > 0) & (field.distance < margins.max() + 2)
    rows, columns = field.rows[near], field.columns[near]
    # Each node of the mask is looked up once.
    nodes, members = np.unique(rows.astype(np.intp) * near.shape[1] + columns, return_inverse=True)
    y, x = np.divmod(nodes, near.shape[1])
    _, nearest = tree.query(np.column_stack([x, y]))
    spread[y, x] = margins[nearest]
    spread[near] = margins[nearest][members.ravel()]
    return spread


def _largest_ring(values: Floats, *, hole: bool) -> tuple[Complexes, float]:
    """Trace the zero level; return its largest ring, and the area in the other rings.

    These are pockets within an outer ring, and parts cut off from a hole.
    """
    # Separate polylines (the generator's default), each with its first point again at the end.
    lines = contourpy.contour_generator(z=values, name="serial").lines(0.0)
    rings = [
        line[:-1, 0] + 1j * line[:-1, 1] for line in cast("list[Floats]", lines) if len(line) > 3
    ]
    areas = np.array([signed_area(ring) for ring in rings])
    largest = int(np.abs(areas).argmax())
    ring = rings[largest]
    # Rings within the outer one run the other way around, the other parts of a hole the same way.
    same = areas * areas[largest] > 0
    left_out = float(np.abs(areas[same == hole]).sum())
    if hole:
        left_out -= abs(float(areas[largest]))
    return (ring if (areas[largest] < 0) == hole else ring[::-1]), left_out
