"""Where two versions of a picture coincide."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from PIL import Image
from scipy import fft

from engine.arrays import Booleans, Bytes, Floats

NEAR = 12  # levels by which the same artwork may differ, such as after a lossy format
SCORED = 100_000  # edges that are compared, at most about
SEARCHED = 512  # pixels of the longer side of the pictures in a search over all places
AGREES = 0.4  # share of equal edges where the pictures overlap: they coincide
SHARES = 0.3  # share of equal edges in the smaller drawing: they coincide
PENALTY = 0.25  # of an edge that differs, in equal edges: it may be redrawn
IS_CLEAR = 0.95  # share at which no better place is searched
BETTER = 0.02  # by which a searched place must be better

Offset = tuple[int, int]  # right and down, in pixels, from the old upper left corner to the new


@dataclass(frozen=True, slots=True, eq=False)
class PlacedPicture:
    """A picture (h, w, 4), first row on top, and its lower left corner on the canvas, y up."""

    rgba: Bytes
    corner: complex

    @property
    def size(self) -> tuple[int, int]:
        return self.rgba.shape[1], self.rgba.shape[0]

    @property
    def content(self) -> "PlacedPicture":
        """The picture without fully transparent rows and columns around it."""
        drawn = self.rgba[..., 3] > 0
        rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
        if not len(rows):
            return PlacedPicture(self.rgba[:0, :0], self.corner)
        (top, bottom), (left, right) = rows[[0, -1]].tolist(), columns[[0, -1]].tolist()
        shift = complex(left, len(self.rgba) - 1 - bottom)
        return PlacedPicture(self.rgba[top : bottom + 1, left : right + 1], self.corner + shift)

    def offset_of(self, other: "PlacedPicture") -> Offset:
        """Return the offset of another picture's upper left corner from this one's."""
        by = other.corner - self.corner
        return round(by.real), round(len(self.rgba) - by.imag - len(other.rgba))

    def corner_at(self, offset: Offset, rows: int) -> complex:
        """Return the lower left corner of a picture with so many rows at an offset from this."""
        right, down = offset
        return self.corner + complex(right, len(self.rgba) - down - rows)


class Alignment(NamedTuple):
    corner: complex  # lower left corner of the new picture on the canvas
    agreement: float  # share of equal edges among those of both pictures where they overlap


def align_pictures(
    before: PlacedPicture, rgba: Bytes, *, expected: complex | None = None
) -> Alignment | None:
    """Return where a new version of a picture coincides with the earlier version.

    Cropped, extended and redrawn parts count as little as possible. Returns None if the pictures
    share too little. Of equally good places, the `expected` corner is taken, then equal centres.
    """
    new = PlacedPicture(rgba, before.corner if expected is None else expected)
    one, other = _Edges.of(before.rgba), _Edges.of(rgba)
    best: tuple[float, float, Offset] | None = None
    for offset in _likely_offsets(before, new, is_expected=expected is not None):
        score, agreement = _compare(one, other, offset)
        if best is None or score > best[0]:
            best = score, agreement, offset
    if best is None or best[1] < IS_CLEAR:
        for offset in _searched_offsets(before.rgba, rgba):
            score, agreement = _compare(one, other, offset)
            if best is None or score > best[0] + BETTER:
                best = score, agreement, offset
    if best is None or best[1] < AGREES or best[0] < SHARES * (1 - PENALTY):
        return None
    return Alignment(before.corner_at(best[2], len(rgba)), best[1])


def agreement_in_place(before: PlacedPicture, now: PlacedPicture) -> float:
    """Return the share of equal edges where both pictures overlap on the canvas."""
    return _compare(_Edges.of(before.rgba), _Edges.of(now.rgba), before.offset_of(now))[1]


@dataclass(frozen=True, slots=True, eq=False)
class _Edges:
    """A picture (h, w, 4), and which of its pixels (h, w) differ from the pixels right and below.

    Equal pixels inside a plain area say little about its place.
    """

    rgba: Bytes
    edges: Booleans

    @classmethod
    def of(cls, rgba: Bytes) -> "_Edges":
        shown = rgba.astype(np.int16) * (rgba[..., 3:] > 0)
        edges = np.zeros(rgba.shape[:2], dtype=np.bool_)
        edges[:-1] |= (np.abs(shown[1:] - shown[:-1]) > NEAR).any(axis=-1)
        edges[:, :-1] |= (np.abs(shown[:, 1:] - shown[:, :-1]) > NEAR).any(axis=-1)
        return cls(rgba, edges)


def _likely_offsets(
    before: PlacedPicture, new: PlacedPicture, *, is_expected: bool
) -> Iterator[Offset]:
    """Yield offsets at which centres, edges or corners of pictures or their contents coincide."""
    if is_expected:
        yield before.offset_of(new)
    inner = before.content, new.content
    for one, other in (inner, (before, new)):
        if not (one.rgba.size and other.rgba.size):
            continue
        base, own = before.offset_of(one), new.offset_of(other)
        across, down = (ours - its for ours, its in zip(one.size, other.size, strict=True))
        for right in dict.fromkeys((across // 2, 0, across)):
            for low in dict.fromkeys((down // 2, 0, down)):
                yield base[0] + right - own[0], base[1] + low - own[1]


def _compare(before: _Edges, after: _Edges, offset: Offset) -> tuple[float, float]:
    """Return a score, the share of equal edges in the smaller drawing, and the agreement.

    Only the overlap of both pictures is compared: beyond it, one of them was cropped.
    """
    (right, down), (rows, columns) = offset, after.edges.shape
    old = np.s_[max(down, 0) : max(down + rows, 0), max(right, 0) : max(right + columns, 0)]
    (height, width) = before.edges[old].shape
    new = np.s_[max(-down, 0) :, max(-right, 0) :]
    first, second = before.edges[old], after.edges[new][:height, :width]
    either = first | second
    count = int(np.count_nonzero(either))
    if not count:
        return -1.0, 0.0
    both = np.flatnonzero(first & second)
    if len(both) > SCORED:
        both = both[:: len(both) // SCORED]
    share = len(both) / max(int(np.count_nonzero(first & second)), 1)
    y, x = np.divmod(both, max(width, 1))
    one = before.rgba[old][y, x].astype(np.int16)
    is_near = (np.abs(one - after.rgba[new][y, x]) <= NEAR).all(axis=-1)
    equal = int(np.count_nonzero(is_near)) / (share or 1.0)
    whole = min(int(np.count_nonzero(each.edges)) for each in (before, after))
    return (equal - PENALTY * (count - equal)) / max(whole, 1), equal / count


def _searched_offsets(before: Bytes, after: Bytes) -> Iterator[Offset]:
    """Yield offsets near the peak of the correlation of both pictures."""
    factor = -(-max(*before.shape[:2], *after.shape[:2]) // SEARCHED)
    one, other = _features(before, factor), _features(after, factor)
    shape = [a + b for a, b in zip(one.shape, other.shape, strict=True)]
    spectrum = fft.rfft2(one, shape) * fft.rfft2(other, shape).conj()
    correlation = fft.irfft2(spectrum, shape)
    down, right = np.unravel_index(int(correlation.argmax()), correlation.shape)
    rough = [
        int(at) - whole if at >= own else int(at)
        for at, whole, own in zip((right, down), shape[::-1], one.shape[::-1], strict=True)
    ]
    reach = range(-factor, factor + 1)
    for across in reach:
        for low in reach:
            yield rough[0] * factor + across, rough[1] * factor + low


def _features(rgba: Bytes, factor: int) -> Floats:
    """Return a reduced picture of its lightness and opacity, with sharp edges only."""
    small = np.asarray(Image.fromarray(rgba).convert("RGBa").reduce(factor), dtype=np.float64)
    levels = small[..., :3].mean(axis=-1) + 0.5 * small[..., 3]
    padded = np.pad(levels, 1)
    around = padded[:-2, 1:-1] + padded[2:, 1:-1] + padded[1:-1, :-2] + padded[1:-1, 2:]
    edges: Floats = levels - around / 4
    return edges
