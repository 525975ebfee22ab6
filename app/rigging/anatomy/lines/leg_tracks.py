"""Legs of a drawing seen from the side, followed from the ground up between lines.

A silhouette joins legs that overlap. The lines of the drawing part them: each level line crosses a
leg in one run between its outlines, and runs that overlap from row to row make a track.
"""

from bisect import bisect_right
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from app.rigging.anatomy.anatomy import bend_share
from engine.arrays import Booleans, Bytes, Complexes, Floats

ROWS = 400  # of the raster: its longer side, at most twice as many
# Largest width of a line as a share of the longer side, and its least contrast to what it parts.
LINE, CONTRAST = 0.02, 0.2
LEAST_RUN = 0.01  # of the longer side
WIDENED = 1.5  # factor over the width so far by which a run leaves its leg
# Widths of a leg from the crotch up to its root; least share of a leg that moves.
ABOVE, FREE = 0.4, 0.7
LEAST_ROWS = 4  # of a track that counts
NEIGHBOUR = 0.5  # of a leg's height: its neighbour's foot is this near
WINDOW = 12  # rows below, whose mean width that is
STITCH = 0.7  # widths between the ends of tracks that a sock or a hem parts
# Shares of the height: feet are this low, legs at least so long, and end this low.
LOW, SHORTEST, HIGHEST = 0.15, 0.14, 0.7
HEM = 0.35  # of the height: a line across a leg is at most so high
SLIM = 1.4  # length over width of a leg, at least
ANKLE = 1.1  # height of the ankle above the sole, in radii of the leg
FOOT = 1.35  # width of a foot's rows over that of the leg


class TrackedLeg(NamedTuple):
    """Joints of a leg: where it leaves the body, its knee or hock, and its ankle."""

    root: complex
    knee: complex
    foot: complex


class _Track(NamedTuple):
    """Runs of one leg from the ground up, in rows of the raster from its lower edge."""

    rows: list[int]
    left: list[int]
    right: list[int]

    def edge(self, edges: Sequence[int], row: int) -> int:
        """Return one of the edges at a row, or at the next one below."""
        return edges[bisect_right(self.rows, row) - 1]

    @property
    def widths(self) -> Floats:
        return np.subtract(self.right, self.left).astype(float)

    @property
    def width_near_top(self) -> float:
        return (sum(self.right[-WINDOW:]) - sum(self.left[-WINDOW:])) / len(self.rows[-WINDOW:])

    @property
    def middles(self) -> Complexes:
        return np.add(self.left, self.right) / 2 + 1j * np.array(self.rows)


def track_legs(loops: Sequence[Complexes], rgba: Bytes, corner: complex) -> tuple[TrackedLeg, ...]:
    """Return the legs that stand on the ground, from the left.

    Parameters
    ----------
    loops : sequence of complex128
        The outline and the outlines of the holes; y up.
    rgba : uint8, shape (h, w, 4)
        The picture.
    corner : complex
        Its lower left corner.
    """
    factor = max(1, max(rgba.shape[:2]) // (2 * ROWS))
    inside, parts = _parts_between_lines(loops, rgba, corner, factor)
    rows = np.flatnonzero(parts.any(axis=1))
    if not len(rows):
        return ()
    ground, tall = int(rows[0]), int(rows[-1] - rows[0])
    tracks = [each for each in _follow_runs(parts) if len(each.rows) >= LEAST_ROWS]
    tracks.sort(key=lambda track: track.rows[0])
    legs, joined = list[_Track](), set[int]()
    for number, track in enumerate(tracks):
        if track.rows[0] - ground > LOW * tall:
            break
        if number in joined:
            continue
        joined |= _extend_upwards(track, tracks, ground + HEM * tall)
        width = float(np.median(track.widths))
        if track.rows[-1] - track.rows[0] >= max(SHORTEST * tall, SLIM * width):
            legs.append(track)
    highest = ground + HIGHEST * tall
    if min((track.rows[-1] for track in legs), default=highest) >= highest:
        return ()
    found = [_leg(track, _find_root(track, legs, inside, highest)) for track in legs]
    placed = [TrackedLeg(*(corner + factor * (at + 0.5 + 0.5j) for at in leg)) for leg in found]
    return tuple(sorted(placed, key=lambda leg: leg.foot.real))


def _find_root(track: _Track, legs: Sequence[_Track], inside: Booleans, highest: float) -> float:
    """Return the row at which a leg leaves the body.

    A leg that is drawn over its neighbour can swing only below the crotch of the silhouette. A leg
    in front whose lines lead on into the body ends at most where its neighbour does.
    """
    above = ABOVE * float(np.median(track.widths))
    top = min(track.rows[-1] + above, highest)
    for other in legs:
        away = other.middles[0].real - track.middles[0].real
        tall = min(top, other.rows[-1]) - track.rows[0]
        if other is track or abs(away) > NEIGHBOUR * tall:
            continue
        left, right = (track, other) if away > 0 else (other, track)
        first = max(left.rows[0], right.rows[0])
        last = min(left.rows[-1], right.rows[-1])
        apart = [
            row
            for row in range(first, last)
            if not inside[row, left.edge(left.right, row) : right.edge(right.left, row)].all()
        ]
        crotch = apart[-1] if apart else first
        free = max(crotch + above, track.rows[0] + FREE * tall)
        top = min(top, other.rows[-1] + above, free)
    return top


def _leg(track: _Track, root: float) -> tuple[complex, complex, complex]:
    """Return root, at this row or straight above the track, knee and ankle in the raster."""
    widths, middles = track.widths, track.middles
    lower = float(np.median(widths[: len(widths) // 2]))
    is_ankle = (widths <= FOOT * lower) & (middles.imag - middles[0].imag >= ANKLE * lower / 2)
    ankle = int(is_ankle.argmax()) if is_ankle.any() else len(widths) // 4
    top = max(int(np.searchsorted(track.rows, root, side="right")) - 1, ankle + 2)
    way = middles[ankle : top + 1][::-1]
    beyond = root - track.rows[-1]
    if beyond > 0:
        below = way[min(WINDOW, len(way) - 1)]
        way = np.append(way[0] + beyond * (way[0] - below) / (way[0] - below).imag, way)
    lengths = np.append(0.0, np.cumsum(np.abs(np.diff(way))))
    share = bend_share(way, lengths)
    knee = int(np.abs(lengths - (0.5 if share is None else share) * lengths[-1]).argmin())
    return complex(way[0]), complex(way[knee]), complex(way[-1])


def _parts_between_lines(
    loops: Sequence[Complexes], rgba: Bytes, corner: complex, factor: int
) -> tuple[Booleans, Booleans]:
    """Return where the drawing is, and where it is and no line, in rows from the lower edge."""
    high, wide = (length // factor for length in rgba.shape[:2])
    inside = np.zeros((high, wide), dtype=bool)
    columns = (np.arange(wide) + 0.5) * factor + corner.real
    for row in range(high):
        y = (row + 0.5) * factor + corner.imag
        crossings = np.sort(np.concatenate([_crossings(loop, y) for loop in loops]))
        inside[row] = np.searchsorted(crossings, columns) % 2 == 1
    lower = rgba.shape[0] - high * factor
    cut = rgba[lower:, : wide * factor, :3].reshape(high, factor, wide, factor, 3)
    brightness = cut.mean(axis=(1, 3, 4))[::-1]
    brightness = np.where(inside, brightness, 255.0)
    size = 2 * int(np.ceil(LINE * max(high, wide) / 2)) + 1
    around = ndimage.grey_closing(brightness, size=(size, size))
    return inside, inside & (around - brightness <= CONTRAST * around)


def _crossings(loop: Complexes, height: float) -> Floats:
    after = np.roll(loop, -1)
    is_crossed = (loop.imag < height) != (after.imag < height)
    a, b = loop[is_crossed], after[is_crossed]
    return np.asarray(a.real + (height - a.imag) / (b.imag - a.imag) * (b.real - a.real))


def _follow_runs(parts: Booleans) -> list[_Track]:
    """Return the tracks of runs that overlap one run above and below, and do not widen."""
    least = max(2, round(LEAST_RUN * max(parts.shape)))
    found, active = list[_Track](), list[_Track]()
    for row, line in enumerate(parts):
        steps = np.diff(np.concatenate([[0], line.astype(np.int8), [0]]))
        starts, ends = np.flatnonzero(steps == 1), np.flatnonzero(steps == -1)
        runs = [
            (a, b) for a, b in zip(starts.tolist(), ends.tolist(), strict=True) if b - a >= least
        ]
        meets = [
            [i for i, track in enumerate(active) if a < track.right[-1] and track.left[-1] < b]
            for a, b in runs
        ]
        above = [sum(i in below for below in meets) for i in range(len(active))]
        now = []
        for (a, b), below in zip(runs, meets, strict=True):
            track = active[below[0]] if len(below) == 1 and above[below[0]] == 1 else None
            if track is not None and b - a <= WIDENED * track.width_near_top:
                track.rows.append(row)
                track.left.append(a)
                track.right.append(b)
            else:
                track = _Track([row], [a], [b])
                found.append(track)
            now.append(track)
        active = now
    return found


def _extend_upwards(track: _Track, others: Sequence[_Track], highest: float) -> set[int]:
    """Add the tracks above a leg from which a line across it, as of a sock, parts it.

    Return their numbers. Lines above a height bound the body.
    """
    width, joined = float(np.median(track.widths)), set[int]()
    for number, other in enumerate(others):
        away = other.middles[0] - track.middles[-1]
        if not 0 < away.imag <= STITCH * width or abs(away.real) > STITCH * width / 2:
            continue
        is_alike = 1 / WIDENED <= float(np.median(other.widths)) / width <= WIDENED
        if is_alike and track.rows[-1] <= highest:
            joined.add(number)
            for one, more in zip(track, other, strict=True):
                one.extend(more)
    return joined
