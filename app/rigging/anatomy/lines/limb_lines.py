"""The drawn line between two limbs that overlap: the near limb's outline over the far limb.

The picture is sampled in strips across the near limb. From the end of the limb to its root, the
line is the path through the strips that meets most ink, or else the sharpest change of colour.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely
from scipy import ndimage

from engine.arrays import Booleans, Bytes, Complexes, Floats, Indices
from engine.geometry import shapely_region

FINEST = 800  # samples of the picture's longer side
# Shares of the near limb's length: rounding of its axis at the knee, its parts sampled beyond its
# end and above its root, and width of the strips.
ROUNDING, BEYOND, ABOVE, WIDE = 0.06, 0.35, 0.15, 0.75
# Largest width of a line as a share of the picture's longer side; contrasts, as shares of the
# brightness and in levels, that count fully.
LINE, DARK, LEVELS = 0.02, 0.2, 40.0
EDGE = 0.7  # weight of a change of colour beside ink
NEAREST = 0.06  # of the room beside the axis: the line is at least this far from it
STEEPEST = 3  # samples across the limb per sample along it
# Costs beside a missing line, which costs 1: of a step across, of the farthest place, and of a
# place where no line may run.
SLOPE, FAR, FORBIDDEN = 0.05, 0.3, 10.0
PAPER, BLURRED = 30.0, 4  # levels of paper, and samples over which a change of colour is seen
MARGIN = 0.02  # of the picture's longer side: the outline's margin around the drawing, at most
SEEN = 0.5  # evidence of a line
# Shares of the limb's length: largest gap in a line, shortest line, and smoothing.
GAP, SHORTEST, SMOOTHING = 0.06, 0.12, 0.02
SURE = 0.7  # share of a line's samples in which it is seen
ASKEW = 0.6  # samples across the limb per sample along it: most on the whole
OPEN = 0.04  # of the limb's length: width of a gap between limbs in which a line may begin


class _Strips(NamedTuple):
    """Samples (n, m) across a limb: rows along its axis from beyond its end to above its root."""

    axis: Complexes  # (n,)
    across: Complexes  # (n,): unit vectors towards the far limb
    step: float  # pixels
    inside: Booleans
    ink: Floats  # 0 to 1
    evidence: Floats  # 0 to 1: of a line or a change of colour
    colours: Floats  # (n, m, 3), levels over white
    margin: int  # samples between the outline and the drawing, at most

    def place(self, rows: Indices, offsets: Floats) -> Complexes:
        return np.asarray(self.axis[rows] + self.step * offsets[rows] * self.across[rows])


def find_limb_line(
    loops: Sequence[Complexes],
    near: Sequence[complex],
    far: Sequence[complex],
    rgba: Bytes,
    corner: complex,
) -> Complexes | None:
    """Return the line that parts a near limb from the far limb behind it, from its end upwards.

    Parameters
    ----------
    loops : sequence of complex128
        The outline and the outlines of the holes; y up.
    near, far : sequence of complex
        Joints of both limbs, each from root to end.
    rgba : uint8, shape (h, w, 4)
        The picture.
    corner : complex
        Its lower left corner.

    Returns
    -------
    complex128, shape (n,), or None
        Along the far side of the near limb's ink, so that the near limb keeps its outline; in gaps
        along their middle. None if the limbs do not touch or no line shows where they part.
    """
    length = float(np.abs(np.diff(near)).sum())
    strips = _sample_strips(loops, near, far, rgba, corner)
    count, width = strips.inside.shape
    rows, samples = np.arange(count), length / strips.step
    is_between = np.arange(width) <= _find_offsets(strips, far)[:, None] + strips.margin
    gaps = _mark_gaps(strips.inside, is_between)
    is_open = np.asarray(gaps.any(axis=1), np.bool_)
    root = count - round(ABOVE * samples)
    touching = rows[~is_open & (rows < root)]
    if len(touching) < SHORTEST * samples:
        return None
    allowed = _mark_allowed(strips, gaps)
    offsets = _find_path(strips, allowed)
    seen: Booleans = strips.evidence[rows, offsets] >= SEEN
    last = _find_end(seen | is_open, int(touching[0]), root, round(GAP * samples))
    along = touching[touching <= last]
    if len(along) < SHORTEST * samples or seen[along].mean() < SURE:
        return None
    if abs(int(offsets[along[-1]]) - int(offsets[along[0]])) > ASKEW * len(along):
        return None
    beside = _move_beyond_ink(strips, offsets, is_open, allowed)
    steady = ndimage.median_filter(beside, 5, mode="nearest")
    smooth = ndimage.gaussian_filter1d(steady, SMOOTHING * samples)
    return strips.place(
        rows[_find_start(allowed, is_open, int(along[0]), OPEN * samples) : last + 1], smooth
    )


def _sample_strips(
    loops: Sequence[Complexes],
    near: Sequence[complex],
    far: Sequence[complex],
    rgba: Bytes,
    corner: complex,
) -> _Strips:
    """Return the strips across a limb on the side of the far limb."""
    longer = max(rgba.shape[:2])
    step = max(1.0, longer / FINEST)
    axis, length = _extended_axis(np.array(near[::-1]), step)
    along = np.gradient(axis)
    across = 1j * along / np.abs(along)
    if _leans_right(axis, across, _resampled(np.array(far[::-1]), step)):
        across = -across
    places = axis[:, None] + step * np.arange(round(WIDE * length / step)) * across[:, None]
    region = shapely_region(loops[0], loops[1:])
    shapely.prepare(region)
    inside = shapely.contains_xy(region, places.real, places.imag)
    colours = np.where(inside[..., None], _sample_colours(rgba, places - corner, step), 255.0)
    brightness = colours.mean(axis=2)
    size = 2 * int(np.ceil(LINE * longer / step / 2)) + 1
    around = ndimage.grey_closing(brightness, size=(1, size))
    ink = np.clip((around - brightness) / (DARK * np.maximum(around, 1.0)), 0.0, 1.0)
    blurred = ndimage.uniform_filter1d(colours, 3, axis=1)
    change = np.zeros(places.shape)
    change[:, 2:-2] = np.abs(blurred[:, 4:] - blurred[:, :-4]).max(axis=2)
    evidence = np.maximum(ink, EDGE * np.clip(change / LEVELS, 0.0, 1.0))
    return _Strips(
        axis, across, step, inside, ink, evidence, colours, round(MARGIN * longer / step)
    )


def _extended_axis(joints: Complexes, step: float) -> tuple[Complexes, float]:
    """Return the rounded axis of a limb, extended at both ends, and the limb's length."""
    bones = np.diff(joints)
    length = float(np.abs(bones).sum())
    below = joints[0] - BEYOND * length * bones[0] / abs(bones[0])
    above = joints[-1] + ABOVE * length * bones[-1] / abs(bones[-1])
    axis = _resampled(np.concatenate([[below], joints, [above]]), step)
    sigma = ROUNDING * length / step
    return ndimage.gaussian_filter1d(axis, sigma, mode="nearest"), length


def _leans_right(axis: Complexes, across: Complexes, far: Complexes) -> bool:
    """Return whether a far limb is mostly on the other side of an axis than `across` points to."""
    middle = slice(len(axis) // 5, -len(axis) // 3)
    nearest = far[np.abs(far - axis[middle, None]).argmin(axis=1)]
    return bool(((nearest - axis[middle]) * across[middle].conj()).real.sum() < 0)


def _resampled(way: Complexes, step: float) -> Complexes:
    lengths = np.append(0.0, np.cumsum(np.abs(np.diff(way))))
    at = np.linspace(0.0, lengths[-1], max(2, round(lengths[-1] / step) + 1))
    return np.asarray(np.interp(at, lengths, way))


def _sample_colours(rgba: Bytes, places: Complexes, step: float) -> Floats:
    """Return the colours (…, 3), over white, at places in pixels from the lower left corner."""
    row, column = rgba.shape[0] - places.imag - 0.5, places.real - 0.5
    # Only the part of the picture around the places.
    low = [max(0, int(axis.min()) - 4) for axis in (row, column)]
    high = [int(axis.max()) + 4 for axis in (row, column)]
    cut = rgba[low[0] : max(high[0], low[0] + 1), low[1] : max(high[1], low[1] + 1)]
    opacity = cut[..., 3:] / 255.0
    over = cut[..., :3] * opacity + 255.0 * (1 - opacity)
    if step > 1:
        over = ndimage.uniform_filter(over, (round(step), round(step), 1))
    at = [row - low[0], column - low[1]]
    layers = [ndimage.map_coordinates(over[..., k], at, order=1, cval=255.0) for k in range(3)]
    return np.stack(layers, axis=-1)


def _find_offsets(strips: _Strips, far: Sequence[complex]) -> Floats:
    """Return for each row how far away the axis of the far limb is, in samples."""
    way = _resampled(np.array(far[::-1]), strips.step)
    nearest = way[np.abs(way - strips.axis[:, None]).argmin(axis=1)]
    away = ((nearest - strips.axis) * strips.across.conj()).real / strips.step
    return np.asarray(np.clip(away, 1.0, strips.inside.shape[1] - 1), np.float64)


def _mark_gaps(inside: Booleans, is_between: Booleans) -> Booleans:
    """Mark background with the drawing on both sides of it, and all beyond the end of the limb."""
    drawn = inside & is_between
    both = np.maximum.accumulate(drawn, axis=1)
    both &= np.maximum.accumulate(drawn[:, ::-1], axis=1)[:, ::-1]
    return np.asarray(~inside & is_between & (both | ~inside[:, :1]), np.bool_)


def _mark_allowed(strips: _Strips, gaps: Booleans) -> Booleans:
    """Mark where the line may run: in gaps, and elsewhere neither in the axis nor at the edge."""
    width = strips.inside.shape[1]
    edges = np.where(strips.inside.all(axis=1), width, strips.inside.argmin(axis=1))
    first = max(1, int(NEAREST * np.median(edges)))
    allowed = strips.inside.copy()
    for row, edge in enumerate(edges.tolist()):
        if gaps[row].any():
            allowed[row] = gaps[row]
            continue
        allowed[row, :first] = False
        allowed[row, max(first, _find_drawn_edge(strips, row, edge)) :] = False
        if not allowed[row].any():
            allowed[row, first] = True
    return allowed


def _find_drawn_edge(strips: _Strips, row: int, edge: int) -> int:
    """Return where the paint begins inside the outline's margin and the ink along the edge."""
    if edge >= strips.inside.shape[1]:
        return edge
    colours, place = strips.colours[row], edge - 1
    lowest = max(0, edge - strips.margin)
    while place > lowest and np.abs(colours[place] - colours[edge - 1]).max() < PAPER:
        place -= 1
    dark = np.flatnonzero(strips.ink[row, max(0, place - BLURRED) : place + 1] >= SEEN)
    if len(dark):
        place = max(0, place - BLURRED) + int(dark[-1])
        while place > 0 and strips.ink[row, place] >= SEEN:
            place -= 1
    return place - BLURRED


def _find_path(strips: _Strips, allowed: Booleans) -> Indices:
    """Return the sample of each row through which the cheapest path leads."""
    count, width = allowed.shape
    costs = 1 - strips.evidence + FAR * np.arange(width) / width
    costs = np.where(allowed, np.where(strips.inside, costs, 0.0), FORBIDDEN)
    moves = np.arange(-STEEPEST, STEEPEST + 1)
    total, choices = costs[0], np.zeros((count, width), dtype=np.intp)
    for row in range(1, count):
        padded = np.pad(total, STEEPEST, constant_values=np.inf)
        windows = np.lib.stride_tricks.sliding_window_view(padded, width)
        options = windows + SLOPE * np.abs(moves)[:, None]
        choices[row] = options.argmin(axis=0)
        total = options.min(axis=0) + costs[row]
    path = np.zeros(count, dtype=np.intp)
    path[-1] = total.argmin()
    for row in range(count - 1, 0, -1):
        path[row - 1] = path[row] + moves[choices[row, path[row]]]
    return path


def _find_end(seen: Booleans, first: int, root: int, gap: int) -> int:
    """Return the last row up to which a line is seen, with short gaps."""
    last = first
    for row in range(first, root):
        if seen[row]:
            last = row
        elif row - last > gap:
            break
    return last


def _find_start(allowed: Booleans, is_open: Booleans, first: int, wide: float) -> int:
    """Return the row below the first touching row from which the gap between limbs is wide."""
    row = first
    while row > 0 and not (is_open[row] and allowed[row].sum() >= wide):
        row -= 1
    return row


def _move_beyond_ink(
    strips: _Strips, offsets: Indices, is_open: Booleans, allowed: Booleans
) -> Floats:
    """Return the offsets moved to the far side of the ink, and to the middle of gaps."""
    moved = offsets.astype(np.float64)
    for row, offset in enumerate(offsets.tolist()):
        if is_open[row]:
            moved[row] = np.flatnonzero(allowed[row]).mean()
            continue
        light = np.flatnonzero(strips.ink[row, offset:] < SEEN)
        moved[row] = offset + (int(light[0]) if len(light) else 0)
    return moved
