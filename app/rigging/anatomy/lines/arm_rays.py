"""Contours around the axes of arms, along rays that leave them on both sides and at the hand.

The path from ray to ray meets as much ink as it can, or else the sharpest changes of colour.
"""

from typing import Any, NamedTuple, Self

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from app.rigging.anatomy.lines.ink_paths import (
    LINE,
    find_cheapest_paths,
    mark_ink,
    width_of_lines,
)
from engine.arrays import Booleans, Bytes, Complexes, Floats, Indices
from engine.geometry import arc_lengths

# Contrast in levels per sample that counts fully; weight of a change of colour beside ink.
LEVELS, EDGE = 20.0, 0.9
OPAQUE = 0.5  # least opacity of the drawing
SOFT = 0.7  # samples: blur of changes of colour
BESIDE = 1.5  # samples beyond the ink of the drawing's edge, in which no line is looked for
SEEN = 0.5  # evidence of a line
WIDEST = 0.3  # of the arm's length: longest ray
THINNEST = 0.03  # of the arm's length: shortest ray
ROUNDING = 0.05  # of the arm's length: rounding of its axis
STEEPEST = 4  # samples between neighbouring rays, at most
# Costs beside a missing line, which costs 1: of a step by one sample, of a line between the axis
# and the path, and of a place where no path may be.
SLOPE, CROSSED, FORBIDDEN = 0.04, 0.5, 2.0
OUTSIDE = 0.95  # evidence of the drawing's own edge, where a hand is beyond the trunk
OPEN = 0.3  # of the arm from its root: there no line is needed
WORST = 0.7  # weight of the side, or the hand, that is seen least
UNEVEN = 0.4  # cost of a width that changes by as much as its mean
LEADING = 0.12  # of the arm's length: its direction below the shoulder is measured over this
ON_TRUNK = 0.5  # of the arm from its root: it lies on the trunk


class ArmRaster(NamedTuple):
    """Samples of a picture, in rows from the lower edge."""

    corner: complex
    factor: int  # pixels of a sample
    drawn: Booleans
    ink: Floats  # 0 to 1
    evidence: Floats  # 0 to 1: of a line or a change of colour inside the drawing

    @classmethod
    def of(cls, rgba: Bytes, corner: complex, finest: int) -> Self:
        """Return the samples of a picture (h, w, 4), at most `finest` in its longer side."""
        factor = max(1, -(-max(rgba.shape[:2]) // finest))
        high, wide = (-(-length // factor) * factor for length in rgba.shape[:2])
        padded = np.pad(rgba, ((0, high - rgba.shape[0]), (0, wide - rgba.shape[1]), (0, 0)))
        blocks = padded[::-1].reshape(high // factor, factor, wide // factor, factor, 4)
        weights = blocks[..., 3:] / 255.0
        opacity = weights.mean(axis=(1, 3))
        colours = (blocks[..., :3] * weights).mean(axis=(1, 3)) / np.maximum(opacity, 1e-9)
        drawn = opacity[..., 0] >= OPAQUE
        low = corner - 1j * (high - rgba.shape[0])
        return cls(low, factor, drawn, *_find_lines(colours, drawn))

    def cells(self, places: Complexes) -> Complexes:
        return np.asarray((places - self.corner) / self.factor - (0.5 + 0.5j))

    def places(self, cells: Complexes) -> Complexes:
        return np.asarray((cells + (0.5 + 0.5j)) * self.factor + self.corner)

    def shows(self, cells: Complexes) -> Booleans:
        """Whether the drawing is at cells (…)."""
        row, column = np.rint(cells.imag).astype(int), np.rint(cells.real).astype(int)
        high, wide = self.drawn.shape
        within = (row >= 0) & (row < high) & (column >= 0) & (column < wide)
        shown = self.drawn[row.clip(0, high - 1), column.clip(0, wide - 1)]
        return np.asarray(within & shown, np.bool_)

    def sample(self, values: Floats, cells: Complexes) -> Floats:
        """Return the nearest of the raster's values at cells (…)."""
        row, column = np.rint(cells.imag).astype(int), np.rint(cells.real).astype(int)
        high, wide = self.drawn.shape
        return np.asarray(values[row.clip(0, high - 1), column.clip(0, wide - 1)])


def _find_lines(colours: Floats, drawn: Booleans) -> tuple[Floats, Floats]:
    """Return the ink, and the evidence of lines inside the drawing."""
    # Light outside, the drawing's edge counts as a line, too.
    wide = width_of_lines(max(drawn.shape))
    ink, at_edge = (
        mark_ink(np.where(drawn, colours.mean(axis=2), each), (wide, wide)) for each in (0.0, 255.0)
    )
    blurred = [ndimage.gaussian_gradient_magnitude(colours[..., k], SOFT) for k in range(3)]
    evidence = np.maximum(ink, EDGE * np.clip(np.max(blurred, axis=0) / LEVELS, 0.0, 1.0))
    depth = ndimage.distance_transform_edt(np.pad(drawn, 1))[1:-1, 1:-1]
    evidence[depth <= _width_of_edge(at_edge, depth) + BESIDE] = 0.0
    return ink, np.asarray(evidence, np.float64)


def _width_of_edge(ink: Floats, depth: Floats) -> float:
    """Return how many samples deep the ink of the drawing's edge usually is."""
    widest = int(np.ceil(LINE * max(ink.shape)))
    for width in range(widest):
        ring = ink[(depth > width) & (depth <= width + 1)]
        if not len(ring) or np.median(ring) < SEEN:
            return float(width)
    return float(widest)


class ArmContours(NamedTuple):
    """Paths around c axes of n points, in samples: down the left side, around the hand, and up.

    Parameters
    ----------
    axes : complex128, shape (c, n)
    starts, steps : complex128, shape (c, r)
        Where rays leave an axis, and what they advance by a sample.
    offsets : intp, shape (c, r)
        Samples along the rays, at which the path is.
    seen : float64, shape (c, r)
        Evidence at the path.
    is_edge : bool, shape (c, r)
        Whether the path is at the edge of the drawing.
    """

    axes: Complexes
    starts: Complexes
    steps: Complexes
    offsets: Indices
    seen: Floats
    is_edge: Booleans

    @property
    def points(self) -> Complexes:
        return np.asarray(self.starts + self.offsets * self.steps)

    def best(self, scores: Floats, count: int) -> Self:
        """Return the contours with the highest scores (c,), the best first."""
        order = np.argsort(-scores)[:count]
        return type(self)._make(each[order] for each in self)

    def joined(self, other: Self) -> Self:
        return type(self)._make(np.concatenate(each) for each in zip(self, other, strict=True))

    def sides(self, values: npt.NDArray[Any]) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
        """Return values (c, r) of the rays on both sides (c, n), each from the root down."""
        count = self.axes.shape[1]
        return values[:, :count], values[:, -count:][:, ::-1]

    def midlines(self) -> Complexes:
        """Return the lines (c, n) in the middle of both sides."""
        left, right = self.sides(self.points)
        return np.asarray((left + right) / 2)

    def half_widths(self) -> Floats:
        """Return half the distances (c, n) of both sides."""
        left, right = self.sides(self.points)
        return np.asarray(np.abs(left - right) / 2)

    def slenderness(self) -> Floats:
        """Return the length of each arm over its width (c,)."""
        lengths = np.abs(np.diff(self.axes, axis=1)).sum(axis=1)
        return np.asarray(lengths / (2 * np.median(self.half_widths(), axis=1)))

    def clearness(self) -> Floats:
        """Return how much of each contour is seen (c,), less for uneven arms; at most 1."""
        count = self.axes.shape[1]
        is_needed = np.linspace(0.0, 1.0, count) >= OPEN
        # Where a hand is beyond the trunk, both of its sides are.
        edges, seen = self.sides(self.is_edge), self.sides(self.seen)
        alone = edges[0] ^ edges[1]
        both = [np.where(alone & edge, 0.0, side) for edge, side in zip(edges, seen, strict=True)]
        parts = (*(side[:, is_needed] for side in both), self.seen[:, count:-count])
        means = np.stack([part.mean(axis=1) for part in parts])
        widths = self.half_widths()[:, is_needed]
        uneven = widths.std(axis=1) / widths.mean(axis=1)
        return np.asarray(
            WORST * means.min(axis=0) + (1 - WORST) * means.mean(axis=0) - UNEVEN * uneven
        )

    def centred(self) -> Complexes:
        """Return the axes moved to the middle of their contours."""
        count = self.axes.shape[1]
        middle, points = self.midlines(), self.points
        tip = points[:, (points.shape[1] - 1) // 2]
        along = middle[:, -1] - middle[:, -1 - count // 5]
        along /= np.maximum(np.abs(along), 1e-9)
        ends = tip - np.median(self.half_widths()[:, -count // 4 :], axis=1) * along
        # Beside the shoulder, which may be open, the axis leads straight on.
        first = round(OPEN * count)
        second = first + max(round(LEADING * count), 1)
        lead = (middle[:, first] - middle[:, second]) * (first / (second - first))
        inner = middle[:, first:-1]
        is_before = ((ends[:, None] - inner) * along[:, None].conj()).real > 0
        ways = [
            resample_axes(np.concatenate([[way[0] + up], way[keep], [end]])[None], count)
            for way, up, keep, end in zip(inner, lead, is_before, ends, strict=True)
        ]
        rounded = ndimage.gaussian_filter1d(
            np.concatenate(ways), ROUNDING * count, axis=1, mode="nearest"
        )
        return np.asarray(rounded, np.complex128)


def resample_axes(ways: Complexes, count: int) -> Complexes:
    """Return evenly spaced points (c, count) along polylines (c, n)."""
    found = np.empty((len(ways), count), dtype=np.complex128)
    for row, way in enumerate(ways):
        lengths = arc_lengths(way)
        found[row] = np.interp(np.linspace(0.0, lengths[-1], count), lengths, way)
    return found


def stretch_axes(axes: Complexes, share: float) -> Complexes:
    """Return axes (c, n) made longer at the hand by a share of their lengths, below 0 shorter."""
    count = axes.shape[1]
    if share <= 0:
        return resample_axes(axes[:, : round(count * (1 + share))], count)
    back = max(count // 8, 1)
    ahead = (axes[:, -1] - axes[:, -1 - back]) * (share * (count - 1) / back)
    return resample_axes(np.column_stack([axes, axes[:, -1] + ahead]), count)


def trace_contours(raster: ArmRaster, axes: Complexes, *, around: int, radii: int) -> ArmContours:
    """Trace a contour around each axis (c, n) of evenly spaced points, in samples.

    `around` is the number of rays around the hand, `radii` that of samples along a ray.
    """
    count = axes.shape[1]
    lengths = np.abs(np.diff(axes, axis=1)).sum(axis=1)
    smooth = ndimage.gaussian_filter1d(axes, ROUNDING * count, axis=1, mode="nearest")
    tangents = np.gradient(smooth, axis=1)
    tangents /= np.abs(tangents)
    turns = np.exp(1j * np.linspace(np.pi / 2, -np.pi / 2, around + 2)[1:-1])
    ends = np.repeat(axes[:, -1:], around, axis=1)
    starts = np.concatenate([axes, ends, axes[:, ::-1]], axis=1)
    rays = [1j * tangents, tangents[:, -1:] * turns, -1j * tangents[:, ::-1]]
    steps = np.concatenate(rays, axis=1) * (WIDEST / radii * lengths)[:, None]
    places = starts[..., None] + steps[..., None] * np.arange(radii)
    is_out = np.logical_or.accumulate(~raster.shows(places), axis=2)
    is_exit = is_out & np.diff(is_out, axis=2, prepend=False)
    shares = np.concatenate([np.linspace(0, 1, count), np.ones(around), np.linspace(1, 0, count)])
    evidence = np.where(is_out, 0.0, raster.sample(raster.evidence, places))
    evidence[is_exit & (shares >= ON_TRUNK)[:, None]] = OUTSIDE
    line = max(2, round(radii * THINNEST / WIDEST))
    crossed = np.pad(np.cumsum(evidence, axis=2), ((0, 0), (0, 0), (line, 0)))[..., :-line]
    costs = 1.0 - evidence + CROSSED * np.minimum(crossed, 1.0) + FORBIDDEN * (is_out & ~is_exit)
    costs[..., :line] += FORBIDDEN
    offsets = find_cheapest_paths(costs, STEEPEST, SLOPE)
    at = offsets[..., None]
    seen, is_edge = (np.take_along_axis(each, at, axis=2)[..., 0] for each in (evidence, is_exit))
    return ArmContours(axes, starts, steps, offsets, seen, is_edge)
