"""Legs of a drawing seen from the side, followed from the ground up between lines.

A silhouette joins legs that overlap. The lines of the drawing part them: each level line crosses a
leg in one run between its outlines, and runs that overlap from row to row make a track.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from app.rigging.anatomy.legs import TrackedLeg
from app.rigging.anatomy.lines.ink_paths import mark_ink, width_of_lines
from engine.arrays import Booleans, Bytes, Complexes, Floats
from engine.geometry import arc_lengths, crossings_at, distance_to_segments

ROWS = 400  # of the raster: its longer side, at most twice as many
OPAQUE = 128.0  # least level of opacity of the drawing
SOFT, SHARP = 1.0, 8.0  # changes of colour: blur in cells, least levels per cell
LEAST_RUN = 0.01  # of the longer side
WIDENED = 1.5  # factor over the width so far by which a run leaves its leg
# Widths of a leg from where its lines end up to its root.
ABOVE = 0.4
TALLER = 1.2  # factor by which legs between changes of colour are taller than between lines
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
# From the ankle on a leg leads straight up: of its widths, how far it may lie beside that line.
ASIDE = 0.5
BENT = 0.03  # of a leg's length: its middle line is farther from a straight line if its knee bends


class _Track(NamedTuple):
    """Runs of one leg from the ground up, in rows of the raster from its lower edge."""

    rows: list[int]
    left: list[int]
    right: list[int]

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
    inside, colours = _rasterize(loops, rgba, corner, factor)
    found = _find_legs(inside & ~_mark_lines(inside, colours))
    # Legs without outlines part where the colour changes.
    others = _find_legs(inside & ~_mark_changes(inside, colours))
    is_taller = _total_height(others) > TALLER * _total_height(found)
    if len(others) >= max(2, len(found)) and is_taller:
        found = others
    placed = [TrackedLeg(*(corner + factor * (at + 0.5 + 0.5j) for at in leg)) for leg in found]
    return tuple(sorted(placed, key=lambda leg: leg.foot.real))


def _total_height(legs: Sequence[tuple[complex, complex, complex]]) -> float:
    return sum(root.imag - foot.imag for root, _, foot in legs)


def _find_legs(parts: Booleans) -> list[tuple[complex, complex, complex]]:
    """Return root, knee and ankle of the legs in the raster."""
    rows = np.flatnonzero(parts.any(axis=1))
    if not len(rows):
        return []
    ground, tall = int(rows[0]), int(rows[-1] - rows[0])
    tracks = [each for each in _follow_runs(parts) if len(each.rows) >= LEAST_ROWS]
    tracks.sort(key=lambda track: track.rows[0])
    legs, joined = list[_Track](), set[int]()
    for number, track in enumerate(tracks):
        if track.rows[0] - ground > LOW * tall:
            break
        if number in joined:
            continue
        _extend_upwards(track, tracks, ground + HEM * tall, joined)
        width = float(np.median(track.widths))
        if track.rows[-1] - track.rows[0] >= max(SHORTEST * tall, SLIM * width):
            legs.append(track)
    highest = ground + HIGHEST * tall
    if min((track.rows[-1] for track in legs), default=highest) >= highest:
        return []
    return [_leg(track, _find_root(track, legs, highest)) for track in legs]


def _find_root(track: _Track, legs: Sequence[_Track], highest: float) -> float:
    """Return the row at which a leg leaves the body.

    A leg in front whose lines lead on into the body ends at most where its neighbour does.
    """
    above = ABOVE * float(np.median(track.widths))
    top = min(track.rows[-1] + above, highest)
    for other in legs:
        away = other.middles[0].real - track.middles[0].real
        tall = min(top, other.rows[-1]) - track.rows[0]
        if other is track or abs(away) > NEIGHBOUR * tall:
            continue
        top = min(top, other.rows[-1] + above)
    return top


def _leg(track: _Track, root: float) -> tuple[complex, complex, complex]:
    """Return root, at this row or straight above the track, knee and ankle in the raster."""
    widths, middles = track.widths, track.middles
    lower = float(np.median(widths[: len(widths) // 2]))
    is_ankle = (widths <= FOOT * lower) & (middles.imag - middles[0].imag >= ANKLE * lower / 2)
    # Part of a foot, beside toes that cover the rest, may be as narrow.
    rows, last = np.arange(len(widths)), len(widths) - 1
    once, twice = (middles.real[np.minimum(rows + round(n * lower), last)] for n in (1, 2))
    is_ankle &= np.abs(middles.real - (2 * once - twice)) <= ASIDE * lower
    ankle = int(is_ankle.argmax()) if is_ankle.any() else len(widths) // 4
    top = max(int(np.searchsorted(track.rows, root, side="right")) - 1, ankle + 2)
    way = middles[ankle : top + 1][::-1]
    beyond = root - track.rows[-1]
    if beyond > 0:
        way = np.append(way[0] + 1j * beyond, way)
    lengths = arc_lengths(way)
    if _distance_from_bones(way, (0, -1)) < BENT * lengths[-1]:
        knee = int(np.abs(lengths - lengths[-1] / 2).argmin())
    else:
        knee = min(
            range(1, len(way) - 1), key=lambda each: _distance_from_bones(way, (0, each, -1))
        )
    return complex(way[0]), complex(way[knee]), complex(way[-1])


def _distance_from_bones(way: Complexes, joints: Sequence[int]) -> float:
    """Return how far a limb's middle line is from straight bones between points of it."""
    bends = way[[*joints]]
    return float(distance_to_segments(way, bends[:-1], bends[1:]).max())


def _rasterize(
    loops: Sequence[Complexes], rgba: Bytes, corner: complex, factor: int
) -> tuple[Booleans, Floats]:
    """Return where the drawing is, and its colours over white, in rows from the lower edge."""
    high, wide = (length // factor for length in rgba.shape[:2])
    inside = np.zeros((high, wide), dtype=bool)
    columns = (np.arange(wide) + 0.5) * factor + corner.real
    for row in range(high):
        y = (row + 0.5) * factor + corner.imag
        inside[row] = np.searchsorted(crossings_at(loops, y), columns) % 2 == 1
    lower = rgba.shape[0] - high * factor
    cut = rgba[lower:, : wide * factor].reshape(high, factor, wide, factor, 4)
    means = cut.mean(axis=(1, 3))[::-1]
    inside &= means[..., 3] >= OPAQUE
    return inside, np.where(inside[..., None], means[..., :3], 255.0)


def _mark_lines(inside: Booleans, colours: Floats) -> Booleans:
    """Mark lines darker than the colour on both sides."""
    wide = width_of_lines(max(inside.shape))
    return np.asarray(mark_ink(colours.mean(axis=2), (wide, wide)) >= 1, np.bool_)


def _mark_changes(inside: Booleans, colours: Floats) -> Booleans:
    """Mark where the colour changes."""
    change = [ndimage.gaussian_gradient_magnitude(colours[..., k], SOFT) for k in range(3)]
    is_change: Booleans = inside & (np.max(change, axis=0) > SHARP)
    return is_change


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


def _extend_upwards(
    track: _Track, others: Sequence[_Track], highest: float, joined: set[int]
) -> None:
    """Add the tracks above a leg from which a line across it, as of a sock, parts it.

    Their numbers are added to those that are joined to a leg. Lines above a height bound the body.
    """
    width = float(np.median(track.widths))
    for number, other in enumerate(others):
        away = other.middles[0] - track.middles[-1]
        if not 0 < away.imag <= STITCH * width or abs(away.real) > STITCH * width / 2:
            continue
        is_alike = 1 / WIDENED <= float(np.median(other.widths)) / width <= WIDENED
        if is_alike and track.rows[-1] <= highest and number not in joined:
            joined.add(number)
            for one, more in zip(track, other, strict=True):
                one.extend(more)
