"""The sides of the slits in an outline: their edges, and the places where they are painted."""

from collections.abc import Sequence

import numpy as np
import shapely

from engine.arrays import Booleans, Complexes, Floats
from engine.geometry import as_xy, edge_vectors

CUT_WIDTH = 0.002  # of the diagonal of the subject's box
BLUNT = 2.0  # mitre limit at the bends of a line
BESIDE = 0.75  # slit widths from a line: the sides of its slit
OVERLAP = 1.1  # of the way to the middle line: how far the sides are painted
# Lengths of edges on the sides of a slit: at its ends, over the diagonal; growth per distance from
# there; and largest.
AT_END, GROWTH, LONGEST = 0.006, 0.5, 0.06
SHORTEST = 0.35  # slit widths: the ends of a shorter edge are merged
SHARP = 110.0  # degrees: turn at a corner that is blunted
STRAIGHT = 0.2  # sine of the angle of two lines that hardly cross


def cut_loop(
    ring: shapely.LinearRing,
    ways: Sequence[Complexes],
    tips: Complexes,
    width: float,
    *,
    hole: bool,
) -> tuple[Complexes, Complexes]:
    """Return a ring of the cut region, with well-sized edges, and its vertices' painted places."""
    ring = shapely.LinearRing(shapely.get_coordinates(ring))
    if shapely.is_ccw(ring) == hole:
        ring = shapely.reverse(ring)
    xy = shapely.get_coordinates(ring)[:-1]
    corners = _without_spikes(
        _without_short_edges(xy[:, 0] + 1j * xy[:, 1], ways, width), ways, width
    )
    lines = _lines_of(corners, ways, width)
    is_side = np.array([line is not None for line in lines])
    ends = np.append(tips, corners[is_side != np.roll(is_side, 1)])  # tips and mouths
    loop: list[complex] = []
    for start, line, end in zip(corners, lines, np.roll(corners, -1), strict=True):
        loop += [start] if line is None else _divided(start, end, ends, width)
    vertices = np.array(loop)
    return vertices, _closed(vertices, ways, tips, width)


def _without_short_edges(loop: Complexes, ways: Sequence[Complexes], width: float) -> Complexes:
    """Return a loop without edges that are too short; the sides of slits keep their ends."""
    on_line = _distances(loop, ways) < BESIDE * width
    while len(loop) > 3:
        lengths = np.abs(edge_vectors(loop))
        shortest = int(lengths.argmin())
        if lengths[shortest] >= SHORTEST * width:
            break
        following = (shortest + 1) % len(loop)
        dropped = following if on_line[shortest] else shortest
        loop, on_line = np.delete(loop, dropped), np.delete(on_line, dropped)
    return loop


def _without_spikes(loop: Complexes, ways: Sequence[Complexes], width: float) -> Complexes:
    """Return a loop whose sharp corners at the mouths of slits are blunted, as room for a cage."""
    blunt: list[complex] = []
    near = _distances(loop, ways) < BESIDE * width
    for before, corner, after, is_near in zip(
        np.roll(loop, 1), loop, np.roll(loop, -1), near, strict=True
    ):
        turn = float(np.angle((after - corner) / (corner - before), deg=True))
        if not is_near or turn < SHARP:
            blunt.append(corner)
            continue
        back = 0.5 * width / np.sin(np.radians(180.0 - turn) / 2)
        for other in (before, after):
            length = abs(other - corner)
            blunt.append(corner + min(back, 0.45 * length) * (other - corner) / length)
    return np.array(blunt)


def _divided(start: complex, end: complex, ends: Complexes, width: float) -> list[complex]:
    """Return the points, without the last, of an edge divided more finely near `ends`."""
    diagonal = width / CUT_WIDTH
    middle = (start + end) / 2
    longest = min(LONGEST * diagonal, AT_END * diagonal + GROWTH * np.abs(ends - middle).min())
    if abs(end - start) <= longest:
        return [start]
    return _divided(start, middle, ends, width) + _divided(middle, end, ends, width)


def _distances(points: Complexes, ways: Sequence[Complexes]) -> Floats:
    """Return the distance of points (n,) from the nearest line."""
    lines = shapely.MultiLineString([as_xy(way) for way in ways])
    distances: Floats = shapely.distance(lines, shapely.points(as_xy(points)))
    return distances


def _lines_of(
    loop: Complexes, ways: Sequence[Complexes], width: float
) -> list[tuple[complex, complex] | None]:
    """Return for each edge on the side of a slit the piece of its line, for others None."""
    starts = np.concatenate([way[:-1] for way in ways])
    pieces = np.concatenate([way[1:] for way in ways]) - starts
    lengths = np.abs(pieces)
    directions = pieces / lengths
    lines: list[tuple[complex, complex] | None] = []
    is_near: Booleans = _distances(loop, ways) < BESIDE * width
    for here, there, near, is_next in zip(
        loop, np.roll(loop, -1), is_near, np.roll(is_near, -1), strict=True
    ):
        lines.append(None)
        if near and is_next:
            middle = (here + there) / 2
            along = np.clip(((middle - starts) / directions).real, 0, lengths)
            away = np.abs(middle - starts - along * directions)
            nearest = int(away.argmin())
            if away[nearest] < BESIDE * width:
                lines[-1] = complex(starts[nearest]), complex(directions[nearest])
    return lines


def _closed(loop: Complexes, ways: Sequence[Complexes], tips: Complexes, width: float) -> Complexes:
    """Return the painted places of a loop's vertices; vertices beside a line are painted on it."""
    lines, closed = _lines_of(loop, ways, width), loop.copy()
    for index, point in enumerate(loop):
        before, after = lines[index - 1], lines[index]
        if np.abs(tips - point).min() < 1e-6 * width or (before is None and after is None):
            continue
        start, along = after or before  # type: ignore[misc]
        place = start + ((point - start) / along).real * along
        if before and after:
            other, across = before
            sine = (along.conjugate() * across).imag
            if abs(sine) > STRAIGHT:
                place = start + ((other - start).conjugate() * across).imag / sine * along
        if abs(place - point) < BLUNT * width:
            closed[index] = point + OVERLAP * (place - point)
    return closed
