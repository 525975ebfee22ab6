"""Samples of a picture in strips across a limb, on the side of another limb."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely
from scipy import ndimage

from app.rigging.anatomy.lines.ink_paths import mark_ink, width_of_lines
from engine.arrays import Booleans, Bytes, Complexes, Floats, Indices
from engine.geometry import arc_lengths, shapely_region

FINEST = 800  # samples of the picture's longer side
# Shares of the limb's length: rounding of its axis at the knee, its parts sampled beyond its end
# and above its root, and width of the strips.
ROUNDING, BEYOND, ABOVE, WIDE = 0.06, 0.6, 0.15, 0.75
LEVELS = 40.0  # contrast that counts fully
EDGE = 0.7  # weight of a change of colour beside ink
OPAQUE = 0.5  # least opacity of the drawing


class Strips(NamedTuple):
    """Samples (n, m) across a limb: rows along its axis from beyond its end to above its root."""

    axis: Complexes  # (n,)
    across: Complexes  # (n,): unit vectors towards the far limb
    step: float  # pixels
    inside: Booleans  # the outline
    drawn: Booleans  # inside and opaque
    ink: Floats  # 0 to 1, of lines that cross the strip
    marks: Floats  # 0 to 1, of lines in any direction
    evidence: Floats  # 0 to 1: of a line or a change of colour across the strip
    traces: Floats  # 0 to 1: the same in any direction

    def find_edges(self) -> Indices:
        """Return the sample of each row at which the drawing ends."""
        width = self.drawn.shape[1]
        ends = np.where(self.drawn.all(axis=1), width, self.drawn.argmin(axis=1))
        return np.asarray(ends, np.intp)

    def place(self, rows: Indices, offsets: Floats) -> Complexes:
        return np.asarray(self.axis[rows] + self.step * offsets[rows] * self.across[rows])

    def place_between(self, rows: Floats, offsets: Floats) -> Complexes:
        """Return the places at fractions of rows."""
        every = np.arange(len(self.axis))
        axis, across = (np.interp(rows, every, each) for each in (self.axis, self.across))
        return np.asarray(axis + self.step * offsets * across)


def sample_strips(
    loops: Sequence[Complexes],
    near: Sequence[complex],
    far: Sequence[complex],
    rgba: Bytes,
    corner: complex,
) -> Strips:
    """Return the strips across a limb on the side of the far limb."""
    longer = max(rgba.shape[:2])
    step = max(1.0, longer / FINEST)
    axis, length = _extended_axis(np.array(near[::-1]), step)
    along = np.gradient(axis)
    across = 1j * along / np.abs(along)
    if _leans_right(axis, across, resample_line(np.array(far[::-1]), step)):
        across = -across
    places = axis[:, None] + step * np.arange(round(WIDE * length / step)) * across[:, None]
    region = shapely_region(loops[0], loops[1:])
    shapely.prepare(region)
    inside = shapely.contains_xy(region, places.real, places.imag)
    colours, opacity = _sample_colours(rgba, places - corner, step)
    drawn = inside & (opacity >= OPAQUE)
    colours = np.where(drawn[..., None], colours, 255.0)
    brightness = colours.mean(axis=2)
    wide = width_of_lines(longer / step)
    ink, marks = (mark_ink(brightness, (high, wide)) for high in (1, wide))
    change, along = (_measure_change(colours, axis) for axis in (1, 0))
    evidence = np.maximum(ink, EDGE * np.clip(change / LEVELS, 0.0, 1.0))
    traces = np.maximum.reduce([evidence, marks, EDGE * np.clip(along / LEVELS, 0.0, 1.0)])
    return Strips(axis, across, step, inside, drawn, ink, marks, evidence, traces)


def _measure_change(colours: Floats, axis: int) -> Floats:
    """Return by how many levels colours change along an axis."""
    blurred = ndimage.uniform_filter1d(colours, 3, axis=axis)
    before, after = (
        ndimage.shift(blurred, np.eye(3)[axis] * by, order=0, mode="nearest") for by in (2, -2)
    )
    return np.asarray(np.abs(after - before).max(axis=2), np.float64)


def _extended_axis(joints: Complexes, step: float) -> tuple[Complexes, float]:
    """Return the rounded axis of a limb, extended at both ends, and the limb's length."""
    bones = np.diff(joints)
    length = float(np.abs(bones).sum())
    below = joints[0] - BEYOND * length * bones[0] / abs(bones[0])
    above = joints[-1] + ABOVE * length * bones[-1] / abs(bones[-1])
    axis = resample_line(np.concatenate([[below], joints, [above]]), step)
    sigma = ROUNDING * length / step
    return ndimage.gaussian_filter1d(axis, sigma, mode="nearest"), length


def _leans_right(axis: Complexes, across: Complexes, far: Complexes) -> bool:
    """Return whether a far limb is mostly on the other side of an axis than `across` points to."""
    middle = slice(len(axis) // 5, -len(axis) // 3)
    nearest = far[np.abs(far - axis[middle, None]).argmin(axis=1)]
    return bool(((nearest - axis[middle]) * across[middle].conj()).real.sum() < 0)


def resample_line(way: Complexes, step: float) -> Complexes:
    lengths = arc_lengths(way)
    at = np.linspace(0.0, lengths[-1], max(2, round(lengths[-1] / step) + 1))
    return np.asarray(np.interp(at, lengths, way))


def _sample_colours(rgba: Bytes, places: Complexes, step: float) -> tuple[Floats, Floats]:
    """Return the colours (…, 3), over white, and the opacity (…), from 0 to 1, at places.

    The places are in pixels from the lower left corner.
    """
    row, column = rgba.shape[0] - places.imag - 0.5, places.real - 0.5
    # Only the part of the picture around the places.
    low = [max(0, int(axis.min()) - 4) for axis in (row, column)]
    high = [int(axis.max()) + 4 for axis in (row, column)]
    cut = rgba[low[0] : max(high[0], low[0] + 1), low[1] : max(high[1], low[1] + 1)]
    opacity = cut[..., 3:] / 255.0
    over = np.concatenate([cut[..., :3] * opacity + 255.0 * (1 - opacity), opacity], axis=2)
    if step > 1:
        over = ndimage.uniform_filter(over, (round(step), round(step), 1))
    at = [row - low[0], column - low[1]]
    colours = [ndimage.map_coordinates(over[..., k], at, order=1, cval=255.0) for k in range(3)]
    return np.stack(colours, axis=-1), ndimage.map_coordinates(over[..., 3], at, order=1)
