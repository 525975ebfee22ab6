"""The knife: lines along which touching parts are separated, by slits in the outline.

A slit is just wide enough for cages. Its sides are cut with the precision of numbers, not of
pixels, and closed again where the drawing is painted. There its two sides reach its middle line,
and a little beyond, so that no gap shows while they lie side by side.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely
from shapely.ops import substring

from engine.arrays import Booleans, Complexes
from engine.domain.outline.slit_sides import BLUNT, CUT_WIDTH, cut_loop
from engine.errors import EngineError
from engine.geometry import as_xy, shapely_region

TREMOR = 0.7  # slit widths: smaller tremor of the hand is smoothed away
NEAR_EDGE = 0.02  # of the diagonal: an end this near to the edge is extended to it
SAMPLES, MOST_SAMPLES = 1_000, 1e6  # of a part and of its box, to estimate the drawn area
SPECK = 2e-4  # of the subject's area: smaller pieces that lines cut off are dropped
THIN = 1.5  # slit widths: narrower strips beside a line are dropped
LEAST_STRIP, MOST_STRIP = 0.25, 4.0  # squares of slit widths: smallest strip, most drawn area
CUTS_OFF = (
    "The knife cuts off {cut_off:.1%} of the drawing, but a layer must be one piece. End the "
    "line inside the drawing, or move the part to its own layer."
)


class CutRegion(NamedTuple):
    """The loops of a domain with slits: the outline, then those of holes.

    Parameters
    ----------
    loops : tuple of complex128
        The holes' run clockwise.
    closed : tuple of complex128
        Painted places of the vertices of each loop.
    """

    loops: tuple[Complexes, ...]
    closed: tuple[Complexes, ...]


def cut_region(
    loops: Sequence[Complexes], lines: Sequence[Complexes], mask: Booleans, diagonal: float
) -> CutRegion:
    """Separate a region along lines.

    Parameters
    ----------
    loops : sequence of complex128
        The outline, counter-clockwise, and the holes, clockwise.
    lines : sequence of complex128, each of shape (n,)
        Polylines, n ≥ 2. They may cross each other, holes and the outline.
    mask : bool, shape (h, w)
        The subject in the region: cell (r, c) is the square [c, c + 1] × [r, r + 1].
    diagonal : float
        Of the subject's box; the slits' width is a part of it.

    Raises
    ------
    EngineError
        If a line misses the region, begins and ends inside, runs along its edge, cuts off a part,
        or is too short.
    """
    width = CUT_WIDTH * diagonal
    whole = shapely_region(loops[0], loops[1:])
    ways = [_reaching_out(_simplified(line, width), whole, width) for line in lines]
    slits = [_cut_strip(way, width) for way in ways]
    _require_touching(whole, slits)
    rest = shapely.difference(whole, shapely.union_all(slits))
    parts = shapely.get_parts(rest)
    piece = _largest(rest)
    # Beside the drawing, a line may cut off a part of the outline's margin.
    others = (part for part in parts if not shapely.equals(part, piece))
    cut_off = sum(_drawn_area(part, mask) for part in others) / np.count_nonzero(mask)
    if cut_off > SPECK:
        raise EngineError(CUTS_OFF, cut_off=cut_off)
    piece = _without_strips(piece, whole, mask, width)
    tips = np.concatenate([way[[0, -1]] for way in ways])
    new = [piece.exterior, *piece.interiors]
    found = [cut_loop(ring, ways, tips, width, hole=number > 0) for number, ring in enumerate(new)]
    return CutRegion(tuple(loop for loop, _ in found), tuple(closed for _, closed in found))


def _drawn_area(part: shapely.Polygon, mask: Booleans) -> float:
    """Estimate the area of a part that belongs to the subject, in cells."""
    left, low, right, high = shapely.bounds(part)
    # Slivers of small area may be long.
    spacing = float(np.sqrt(max(part.area / SAMPLES, (right - left) * (high - low) / MOST_SAMPLES)))
    if not spacing:
        return 0.0
    x, y = np.meshgrid(np.arange(left, right, spacing), np.arange(low, high, spacing))
    inside = shapely.contains_xy(part, x, y)
    columns, rows = x[inside].astype(int), y[inside].astype(int)
    on_grid = (columns >= 0) & (columns < mask.shape[1]) & (rows >= 0) & (rows < mask.shape[0])
    return float(np.count_nonzero(mask[rows[on_grid], columns[on_grid]])) * spacing**2


def _simplified(line: Complexes, width: float) -> Complexes:
    """Return a line with few vertices, without the tremor of the hand."""
    way = shapely.simplify(shapely.LineString(as_xy(line)), TREMOR * width)
    if way.length < 4 * width:
        raise EngineError("The knife's line is too short to separate anything; draw a longer line.")
    xy = shapely.get_coordinates(way)
    return np.asarray(xy[:, 0] + 1j * xy[:, 1])


def _reaching_out(way: Complexes, whole: shapely.Polygon, width: float) -> Complexes:
    """Return a line inside a region, with ends near the edge extended to it.

    The visible edge lies farther inside than the outline, by the outline's margin.
    """
    if not shapely.contains_properly(whole, shapely.LineString(as_xy(way))):
        return way
    ends = shapely.points(as_xy(way[[0, -1]]))
    away = shapely.distance(whole.boundary, ends)
    last = bool(away[1] < away[0])
    if away.min() > NEAR_EDGE * width / CUT_WIDTH:
        return way
    nearest = shapely.shortest_line(ends[int(last)], whole.boundary)
    inner, edge = shapely.get_coordinates(nearest) @ [1, 1j]
    outside = edge + width * (edge - inner) / max(abs(edge - inner), 1e-9 * width)
    return np.append(way, outside) if last else np.append(outside, way)


def _cut_strip(way: Complexes, width: float) -> shapely.Geometry:
    """Return the strip that is cut out along a line, with pointed ends."""
    line = shapely.LineString(as_xy(way))
    half = width / 2
    inner = substring(line, half, line.length - half)
    strip = shapely.buffer(inner, half, cap_style="flat", join_style="mitre", mitre_limit=BLUNT)
    points = []
    for end, before in ((way[0], way[1]), (way[-1], way[-2])):
        along = half * (before - end) / abs(before - end)
        # A hair longer, so that strip and point merge.
        corners = np.array([end, end + 1.001 * (1 + 1j) * along, end + 1.001 * (1 - 1j) * along])
        points.append(shapely.Polygon(as_xy(corners)))
    return shapely.union_all([strip, *points])


def _require_touching(whole: shapely.Polygon, slits: Sequence[shapely.Geometry]) -> None:
    """Raise `EngineError` if a slit misses the region, or lies inside and meets no other slit."""
    if not all(shapely.intersects(whole, slit) for slit in slits):
        raise EngineError("The knife's line does not touch the drawing; draw it across an edge.")


def _without_strips(
    piece: shapely.Polygon, whole: shapely.Polygon, mask: Booleans, width: float
) -> shapely.Polygon:
    """Return a piece without the thin strips that lines leave beside edges.

    Raises
    ------
    EngineError
        If a strip is a part of the drawing.
    """
    left = shapely.difference(
        shapely.intersection(piece, _opened(whole, width)), _opened(piece, width)
    )
    parts = shapely.get_parts(left)
    strips = parts[shapely.area(parts) > LEAST_STRIP * width**2]
    if sum(_drawn_area(strip, mask) for strip in strips) > MOST_STRIP * width**2:
        raise EngineError(
            "The knife's line runs along an edge or another line and leaves too thin a strip; "
            "draw it farther away."
        )
    rest = shapely.difference(piece, shapely.buffer(shapely.union_all(strips), 1e-3 * width))
    return _largest(rest)


def _opened(area: shapely.Polygon, width: float) -> shapely.Geometry:
    """Return the parts of an area that are wider than some slits."""
    half, options = THIN * width / 2, {"join_style": "mitre", "mitre_limit": 5.0}
    return shapely.buffer(shapely.buffer(area, -half, **options), 1.01 * half, **options)


def _largest(area: shapely.Geometry) -> shapely.Polygon:
    parts = shapely.get_parts(area)
    return parts[int(shapely.area(parts).argmax())]
