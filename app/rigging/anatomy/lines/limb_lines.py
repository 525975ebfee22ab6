"""The drawn line between two limbs that overlap: the near limb's outline over the far limb.

The picture is sampled in strips across the near limb. From the end of the limb to its root, the
line is the path through the strips that meets most ink, or else the sharpest change of colour.
"""

from collections.abc import Sequence
from typing import Literal, NamedTuple, Self

import numpy as np
import shapely
from scipy import ndimage

from app.rigging.anatomy.lines.around_toes import lead_round_toes
from app.rigging.anatomy.lines.ink_paths import find_cheapest_paths
from app.rigging.anatomy.lines.limb_strips import (
    ABOVE,
    BEYOND,
    Strips,
    resample_line,
    sample_strips,
)
from engine.arrays import Booleans, Bytes, Complexes, Floats, Indices
from engine.geometry import as_xy, shapely_region

NEAREST = 0.06  # of the room beside the axis: the line is at least this far from it
STEEPEST = 3  # samples across the limb per sample along it, at most
# Costs beside a missing line, which costs 1: of a step across, of the farthest place, and of a
# place where no line may run.
SLOPE, FAR, FORBIDDEN = 0.02, 0.3, 10.0
BLURRED = 4  # samples over which a change of colour is seen
SEEN = 0.5  # evidence of a line
# Shares of the limb's length: largest gap in a line, shortest line, smoothing, and how far beyond
# the far limb's axis that limb is looked for.
GAP, SHORTEST, SMOOTHING, NEAR_FAR = 0.06, 0.12, 0.02, 0.04
INSTEP = 0.08  # of the limb's length: how far above its end toes begin
STEEP = 1.2  # samples across the limb per sample along it: there the line leaves the limb
BRIDGE = 0.2  # of the far limb's greatest visible width: least width where the line ends
THICK = 1.25  # of the usual width of a line: most of one
WEBBED = 0.3  # of the limb's length: shortest closed gap that parts limbs without a line above it
SURE = 0.7  # share of a line's samples in which it is seen
ASKEW = 0.6  # samples across the limb per sample along it: most on the whole
# Of the limb's length: how far above and beside a gap outlines are compared, by rows of at least.
GOES_ON, LEAST_ROWS = 0.2, 4
OPEN = 0.01  # of the limb's length: width of a gap of the outline in which a line may begin


class LimbLine(NamedTuple):
    """The line that parts a near limb from a far one, from the end upwards."""

    points: Complexes  # (n,)
    crotch: int  # index of the point from which on the near limb covers the far one
    far_side: Literal["left", "right"]

    def shortened(self, share: float) -> Self:
        """Return the line up to a share of its part above the crotch."""
        end = self.crotch + round(share * (len(self.points) - self.crotch))
        return self._replace(points=self.points[: max(end, 2)])


def find_limb_line(
    loops: Sequence[Complexes],
    near: Sequence[complex],
    far: Sequence[complex],
    rgba: Bytes,
    corner: complex,
    *,
    may_be_behind: bool = False,
) -> LimbLine | None:
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
    may_be_behind : bool
        Whether the "near" limb may lie behind the other, as an arm behind the trunk. The line above
        a gap is of the one in front: it goes straight on as that one's outline beside the gap.

    Returns
    -------
    LimbLine or None
        Beside the ink, so that the limb in front keeps its outline; in gaps along their middle.
        None if the limbs do not touch or no line shows where they part.
    """
    length = float(np.abs(np.diff(near)).sum())
    strips = sample_strips(loops, near, far, rgba, corner)
    count, width = strips.inside.shape
    rows, samples = np.arange(count), length / strips.step
    behind = _find_offsets(strips, far)[:, None]
    is_between = np.arange(width) <= behind + NEAR_FAR * samples
    # The outline closes narrow gaps of the drawing: such limbs touch, too.
    gaps, apart = _mark_gaps(strips.drawn, is_between), _mark_gaps(strips.inside, is_between)
    is_open, is_apart = (np.asarray(each.any(axis=1), np.bool_) for each in (gaps, apart))
    ankle, root = round(BEYOND * samples), count - round(ABOVE * samples)
    ends = strips.axis + strips.step * behind[:, 0] * strips.across
    ways = shapely.linestrings(np.stack([as_xy(strips.axis), as_xy(ends)], axis=1))
    # Slits are thinner than the samples.
    is_one = shapely.covers(shapely_region(loops[0], loops[1:]), ways)
    touching = rows[~is_apart & is_one & (rows < root)]
    if len(touching) < SHORTEST * samples:
        return None
    instep = ankle + round(INSTEP * samples)
    offsets = _find_path(strips, _mark_allowed(strips, gaps, ankle))
    seen: Booleans = strips.evidence[rows, offsets] >= SEEN
    crotch = int(rows[is_open & (rows < root)].max(initial=int(touching[0])))
    is_behind = may_be_behind and _goes_on_as_far(offsets, gaps, crotch, round(GOES_ON * samples))
    ink = _measure_line(strips, offsets, gaps)
    beside = _move_beyond_ink(ink, is_behind=is_behind)
    steady = ndimage.median_filter(beside, 5, mode="nearest")
    # Around the toes the line leads straight on to the ground, and not back under the sole.
    steady[: ankle + 1] = np.maximum.accumulate(steady[ankle::-1])[::-1]
    smooth = ndimage.gaussian_filter1d(steady, SMOOTHING * samples)
    room = strips.find_edges() - smooth
    last = _find_end(seen, crotch, root, round(GAP * samples))
    wide = BRIDGE * room[crotch : last + 1].max()
    is_end = (room < wide) | (np.abs(np.gradient(smooth)) > STEEP)
    is_end[: max(crotch + round(SHORTEST * samples), (int(touching[0]) + root) // 2)] = False
    last = min(last, int(np.append(is_end[:last], True).argmax()))
    if last - crotch < SHORTEST * samples or seen[crotch + 1 : last + 1].mean() < SURE:
        last = crotch  # the limbs part at the gap only
    if last - int(touching[0]) < (SHORTEST if last > crotch else WEBBED) * samples:
        return None
    if abs(smooth[last] - smooth[crotch]) > ASKEW * (last - crotch):
        return None
    first = int(touching[0])
    while first > 0 and apart[first].sum() < OPEN * samples:
        first -= 1
    is_left = (strips.across[first] / (strips.axis[first + 1] - strips.axis[first])).imag > 0
    low = strips.place(rows[first:instep], smooth)
    if not may_be_behind:
        toes = lead_round_toes(strips, instep, float(smooth[instep]), ink.usual)
        low = toes if len(toes) else low
    points = np.concatenate([low, strips.place(rows[max(first, instep) : last + 1], smooth)])
    branch = strips.place(rows[crotch : crotch + 1], smooth)
    return LimbLine(
        points=points,
        crotch=int(np.abs(points - branch).argmin()),
        far_side="left" if is_left else "right",
    )


def _find_offsets(strips: Strips, far: Sequence[complex]) -> Floats:
    """Return for each row how far away the axis of the far limb is, in samples."""
    way = resample_line(np.array(far[::-1]), strips.step)
    nearest = way[np.abs(way - strips.axis[:, None]).argmin(axis=1)]
    away = ((nearest - strips.axis) * strips.across.conj()).real / strips.step
    return np.asarray(np.clip(away, 1.0, strips.drawn.shape[1] - 1), np.float64)


def _mark_gaps(drawn: Booleans, is_between: Booleans) -> Booleans:
    """Mark background with the drawing on both sides of it, and all beyond the end of the limb."""
    limbs = drawn & is_between
    both = np.maximum.accumulate(limbs, axis=1)
    both &= np.maximum.accumulate(limbs[:, ::-1], axis=1)[:, ::-1]
    return np.asarray(~drawn & is_between & (both | ~drawn[:, :1]), np.bool_)


def _mark_allowed(strips: Strips, gaps: Booleans, ankle: int) -> Booleans:
    """Mark where the line may run: in gaps, and elsewhere neither in the axis nor at the edge.

    Below the ankle's row, the near foot may be at the edge.
    """
    edges = strips.find_edges()
    first = max(1, int(NEAREST * np.median(edges)))
    allowed = strips.drawn.copy()
    for row, edge in enumerate(edges.tolist()):
        if gaps[row].any():
            allowed[row] = gaps[row]
            continue
        allowed[row, :first] = False
        if row >= ankle:
            allowed[row, max(first, _find_edge(strips, row, edge)) :] = False
        if not allowed[row].any():
            allowed[row, first] = True
    return allowed


def _find_edge(strips: Strips, row: int, edge: int) -> int:
    """Return where paint begins inside the ink along the drawing's edge."""
    if edge >= strips.drawn.shape[1]:
        return edge
    place = edge
    dark = np.flatnonzero(strips.ink[row, max(0, edge - BLURRED) : edge] >= SEEN)
    if len(dark):
        place = max(0, edge - BLURRED) + int(dark[-1])
        while place > 0 and strips.ink[row, place] >= SEEN:
            place -= 1
    return place - BLURRED


def _find_path(strips: Strips, allowed: Booleans) -> Indices:
    """Return the sample of each row through which the cheapest path leads."""
    width = allowed.shape[1]
    costs = 1 - strips.evidence + FAR * np.arange(width) / width
    costs = np.where(allowed, np.where(strips.drawn, costs, 0.0), FORBIDDEN)
    return np.asarray(find_cheapest_paths(costs[None], STEEPEST, SLOPE)[0], np.intp)


def _find_end(seen: Booleans, first: int, root: int, gap: int) -> int:
    """Return the last row up to which a line is seen, with short gaps."""
    last = first
    for row in range(first, root):
        if seen[row]:
            last = row
        elif row - last > gap:
            break
    return last


def _goes_on_as_far(offsets: Indices, gaps: Booleans, crotch: int, count: int) -> bool:
    """Return whether the line above a gap goes on as the far limb's outline beside the gap."""
    below = np.flatnonzero(gaps[: crotch + 1].any(axis=1))[-count:]
    above = np.arange(crotch + 1, min(crotch + 1 + count, len(offsets)))
    if min(len(below), len(above)) < LEAST_ROWS:
        return False
    near, far = gaps[below].argmax(axis=1), gaps.shape[1] - gaps[below, ::-1].argmax(axis=1)
    slope, *slopes = (
        float(np.polyfit(rows, places, 1)[0])
        for rows, places in ((above, offsets[above]), (below, near), (below, far))
    )
    return abs(slope - slopes[1]) < abs(slope - slopes[0])


class _LineEnds(NamedTuple):
    """Where the ink of a line begins and ends in each row, and the most that it usually is wide.

    Beside a line of no ink, both are where the light begins; in gaps, their middle.
    """

    starts: Floats
    stops: Floats
    is_line: Booleans
    usual: float


def _measure_line(strips: Strips, offsets: Indices, gaps: Booleans) -> _LineEnds:
    is_ink, width = strips.ink >= SEEN, strips.ink.shape[1]
    ends = np.stack([offsets, offsets]).astype(np.float64)
    for row, offset in enumerate(offsets.tolist()):
        if gaps[row].any():
            ends[:, row] = np.flatnonzero(gaps[row]).mean()
            continue
        light = np.flatnonzero(~is_ink[row])
        ends[0, row] = light[light <= offset].max(initial=0)
        if is_ink[row, offset]:
            ends[1, row] = light[light > offset].min(initial=width - 1)
    starts, stops = ends
    is_line = ~gaps.any(axis=1) & is_ink[np.arange(len(offsets)), offsets]
    usual = THICK * float(np.median((stops - starts)[is_line])) if is_line.any() else 0.0
    return _LineEnds(starts, stops, is_line, usual)


def _move_beyond_ink(line: _LineEnds, *, is_behind: bool) -> Floats:
    """Return the offsets moved beyond the ink of the limb in front, and to the middle of gaps.

    Near the crotch, where the outlines of both limbs are one line, only the usual width of a line
    is that limb's. `is_behind` says that the far limb is in front.
    """
    starts, stops, is_line, usual = line
    moved = np.maximum(starts, stops - usual) if is_behind else np.minimum(stops, starts + usual)
    moved[~is_line] = (starts if is_behind else stops)[~is_line]
    return np.asarray(moved, np.float64)
