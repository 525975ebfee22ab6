"""One piece of a subject: specks dropped, parts joined by bridges, holes found."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import minimum_spanning_tree

from engine.arrays import Booleans, Complexes, Floats, Indices, Integers
from engine.errors import EngineError, Message, count_message

SPECK = 2e-4  # of the subject's area: smaller parts are dropped, smaller holes are filled
MOST_PARTS = 150
MOST_DROPPED = 0.05  # of the subject's area
CLOUD = 6  # number of parts from which gaps are closed as well as bridged
CLOUD_GAP = 0.04  # of the diagonal: widest half gap that is closed between many parts
BRIDGE_WIDTHS = (0.012, 0.05)  # of the diagonal
WITH_CORNERS = ((1, 1, 1), (1, 1, 1), (1, 1, 1))  # neighbours that are connected to a pixel
FRAGMENTED = (
    "The subject has too many parts: {count:,}, with specks on {dropped:.0%} of the area. Give "
    "a picture with at most {most} parts."
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WholePiece:
    """A subject in one piece, and its holes.

    Parameters
    ----------
    mask : bool, shape (h, w)
        The subject with its holes filled.
    holes : int32, shape (h, w)
        The number of each pixel's hole, from 1, the largest hole first; 0 elsewhere.
    hole_areas : float64, shape (m,)
        Of the holes, in pixels.
    notices : tuple of Message
        Reports of joined and dropped parts.
    """

    mask: Booleans
    holes: Integers
    hole_areas: Floats
    notices: tuple[Message, ...]

    def numbers_at(self, points: Complexes) -> Indices:
        """Return the numbers of the holes at points (n,) in cells, y along the rows."""
        rows, columns = np.floor(points.imag), np.floor(points.real)
        height, width = self.holes.shape
        inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        rows, columns = rows[inside].astype(np.intp), columns[inside].astype(np.intp)
        found = np.unique(self.holes[rows, columns])
        return found[found > 0].astype(np.intp)

    def largest_share(self, numbers: Sequence[int] | Indices) -> float:
        """Return the area of the largest of these holes, over that of the subject."""
        areas = self.hole_areas[np.asarray(numbers, dtype=np.intp) - 1]
        return float(areas.max(initial=0)) / np.count_nonzero(self.mask)


def join_parts(mask: Booleans, diagonal: float) -> WholePiece:
    """Make one piece of a mask.

    Parameters
    ----------
    mask : bool, shape (h, w)
        With at least one free pixel all around.
    diagonal : float
        Of the subject's box, in pixels of the mask.

    Raises
    ------
    EngineError
        If the mask has too many parts to be joined.
    """
    labels, count = ndimage.label(mask, WITH_CORNERS)
    areas = np.bincount(labels.ravel(), minlength=count + 1)[1:].astype(np.float64)
    kept = areas >= SPECK * areas.sum()
    _require_few_parts(areas, kept)
    notices: list[Message] = []
    if not kept.all():
        specks = int(np.count_nonzero(~kept))
        notices.append(
            count_message(
                "{count:,} speck dropped ({share:.2%} of the subject)",
                "{count:,} specks dropped ({share:.2%} of the subject)",
                specks,
                share=areas[~kept].sum() / areas.sum(),
            )
        )
        numbers = np.where(kept, np.cumsum(kept), 0).astype(np.int32)
        labels = np.append(np.zeros(1, dtype=np.int32), numbers)[labels]
        mask, areas, count = labels > 0, areas[kept], int(kept.sum())
    if count > 1:
        mask = _bridged(mask, labels.astype(np.int32), areas, diagonal)
        notices.append(Message("{count} parts joined by invisible bridges", {"count": count}))
    filled, holes, hole_areas = _filled(mask)
    return WholePiece(mask=filled, holes=holes, hole_areas=hole_areas, notices=tuple(notices))


def _require_few_parts(areas: Floats, kept: Booleans) -> None:
    """Raise `EngineError` unless a few parts hold nearly all of the subject."""
    dropped = areas[~kept].sum() / areas.sum()
    if dropped > MOST_DROPPED or np.count_nonzero(kept) > MOST_PARTS:
        raise EngineError(FRAGMENTED, count=len(areas), dropped=dropped, most=MOST_PARTS)


def _bridged(mask: Booleans, labels: Integers, areas: Floats, diagonal: float) -> Booleans:
    """Join the labelled parts; if there are many, gaps between them are closed as well."""
    starts, ends, widths = _shortest_bridges(mask, labels, areas, diagonal)
    joined = mask.copy()
    for start, end, width in zip(starts.tolist(), ends.tolist(), widths.tolist(), strict=True):
        _draw_capsule(joined, start, end, width)
    if len(areas) < CLOUD:
        return joined
    half_gap = float(np.abs(ends - starts).max()) / 2
    return _closed(joined, min(half_gap, CLOUD_GAP * diagonal))


def _shortest_bridges(
    mask: Booleans, labels: Integers, areas: Floats, diagonal: float
) -> tuple[Complexes, Complexes, Floats]:
    """Return the minimum spanning tree of the parts: starts x + iy, ends and widths of bridges.

    Where the nearest part changes from one pixel to the next, the nearest pixels of both parts
    make a candidate; the tree's edges are among these (it lies in the Delaunay graph).
    """
    rows, columns = ndimage.distance_transform_edt(
        ~mask, return_distances=False, return_indices=True
    )
    owner = labels[rows, columns]
    pairs: list[Indices] = []
    for here, there in ((np.s_[:, :-1], np.s_[:, 1:]), (np.s_[:-1, :], np.s_[1:, :])):
        change = owner[here] != owner[there]
        both = [part[side][change] for side in (here, there) for part in (owner, rows, columns)]
        pairs.append(np.stack(both))
    part0, y0, x0, part1, y1, x1 = np.concatenate(pairs, axis=1).astype(np.intp)
    starts, ends = x0 + 1j * y0, x1 + 1j * y1
    length = np.abs(ends - starts)
    low, high = np.minimum(part0, part1) - 1, np.maximum(part0, part1) - 1
    chosen = _central_shortest(low * len(areas) + high, starts, ends)
    low, high, length = low[chosen], high[chosen], length[chosen]
    shape = (len(areas), len(areas))
    tree = minimum_spanning_tree(coo_array((length, (low, high)), shape=shape).tocsr()).tocoo()
    used = np.isin(low * len(areas) + high, tree.row * len(areas) + tree.col)
    side = np.sqrt(np.minimum(areas[low], areas[high]))[used]
    narrowest, widest = BRIDGE_WIDTHS
    widths = np.clip(0.5 * side, narrowest * diagonal, widest * diagonal)
    return starts[chosen][used], ends[chosen][used], widths


def _central_shortest(keys: Indices, starts: Complexes, ends: Complexes) -> Indices:
    """Return, for each key, one of its nearly shortest segments: the middle one.

    Between parallel sides all segments are equally short; a bridge belongs in their middle.
    """
    _, group = np.unique(keys, return_inverse=True)
    length, middle = np.abs(ends - starts), (starts + ends) / 2
    shortest = np.full(group.max() + 1, np.inf)
    np.minimum.at(shortest, group, length)
    near = np.flatnonzero(length <= 1.02 * shortest[group] + 0.5)
    group, middle = group[near], middle[near]
    count = np.bincount(group)
    centre = (np.bincount(group, middle.real) + 1j * np.bincount(group, middle.imag)) / count
    order = np.lexsort((np.abs(middle - centre[group]), group))
    return np.asarray(near[order[np.flatnonzero(np.diff(group[order], prepend=-1))]])


def _draw_capsule(mask: Booleans, start: complex, end: complex, width: float) -> None:
    """Set the pixels within `width` / 2 of the segment, in place."""
    radius = width / 2
    low_x, high_x = sorted((start.real, end.real))
    low_y, high_y = sorted((start.imag, end.imag))
    rows = slice(max(0, int(low_y - radius)), int(high_y + radius) + 2)
    columns = slice(max(0, int(low_x - radius)), int(high_x + radius) + 2)
    window = mask[rows, columns]
    y, x = np.ogrid[: window.shape[0], : window.shape[1]]
    offset = x + columns.start + 1j * (y + rows.start) - start
    along = (end - start) / max(abs(end - start), 1.0)
    nearest = np.clip((offset * np.conj(along)).real, 0, abs(end - start)) * along
    window |= np.abs(offset - nearest) <= radius


def _closed(mask: Booleans, radius: float) -> Booleans:
    """Close the gaps too narrow for a disc of `radius`."""
    padding = int(np.ceil(radius)) + 1
    padded = np.pad(mask, padding)
    grown = ndimage.distance_transform_edt(~padded) <= radius
    kept = ndimage.distance_transform_edt(grown) > radius
    inner = slice(padding, -padding)
    return mask | kept[inner, inner]


def _filled(mask: Booleans) -> tuple[Booleans, Integers, Floats]:
    """Fill everything that a flood from the outside, pixel (0, 0), does not reach.

    Return the filled mask, the number (h, w) of each pixel's hole, the largest first and 0 where
    there is none or one that is smaller than a speck, and the area of each hole.
    """
    labels, count = ndimage.label(~mask)
    outside = labels[0, 0]
    areas = np.bincount(labels.ravel(), minlength=count + 1).astype(np.float64)
    filled = areas.sum() - areas[outside]
    areas[[0, outside]] = 0
    areas[areas < SPECK * filled] = 0
    by_size = np.argsort(-areas, kind="stable")
    numbers = np.zeros(count + 1, dtype=np.int32)
    holes = int(np.count_nonzero(areas))
    numbers[by_size[:holes]] = np.arange(1, holes + 1)
    return labels != outside, numbers[labels], areas[by_size[:holes]]
