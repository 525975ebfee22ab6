"""The edge of a subject in a part of its picture: the mixture in each of its pixels.

Pixels are measured in their tones, brightness, blueness and redness: JPEG blurs the last two.
"""

from typing import NamedTuple, Self

import numpy as np
from scipy import ndimage

from engine.arrays import Booleans, Bytes, Floats, Indices

NEARBY = 8  # pixels: radius of the mean of the background's colour
SURE = 2.0  # pixels off the mask from which a pixel is pure background
NOISE_REACH = 2  # pixels: variation within this radius is noise
# Brightness, blueness, redness of red, green, blue.
TONES = ((0.299, 0.587, 0.114), (-0.169, -0.331, 0.5), (0.5, -0.419, -0.081))
HUES = (1, 2)  # the last two of them
PICTURE_NOISE = 0.5  # least noise of every picture, in levels


class Tile(NamedTuple):
    """A part of a picture with some context around it.

    Parameters
    ----------
    rgb, tones : float64, shape (h, w, 3)
        Colours, and their brightness, blueness and redness.
    depth : float64, shape (h, w)
        Distance in pixels of each subject pixel from the background; of each background pixel from
        the subject, as a negative number; ±1 next to the border between them.
    background, noise : float64, shape (h, w, 3)
        Mean and variance of the background's tones nearby.
    """

    rgb: Floats
    tones: Floats
    subject: Booleans
    depth: Floats
    background: Floats
    noise: Floats

    @classmethod
    def of(cls, rgb: Bytes, subject: Booleans, paper: Floats) -> Self:
        """Measure a part of a picture; its background is `paper` (3,) where none is nearby."""
        colours = rgb.astype(np.float64)
        tones = tones_of(colours)
        inside = ndimage.distance_transform_edt(subject)
        depth = inside - ndimage.distance_transform_edt(~subject)
        sure = depth < -SURE
        if not sure.any():
            sure = depth < 0
        background, noise = _local(tones, sure, NEARBY, tones_of(paper))
        return cls(colours, tones, subject, depth, background, noise)


class Mixture(NamedTuple):
    """The pixels (n,) at the edge, as flat indices of a tile, and their mixtures.

    Parameters
    ----------
    band, core : int64
        The pixels, and for each the nearest pixel where the subject is pure.
    way, off : float64, shape (n, 3)
        From the tones of the background to those of the subject, and to those of the pixel.
    noise : float64, shape (n, 3)
        Variance of these tones.
    """

    band: Indices
    core: Indices
    way: Floats
    off: Floats
    noise: Floats

    @classmethod
    def of(cls, tile: Tile, width: int) -> Self:
        """Return the mixtures of the edge in a tile, `width` pixels wide."""
        band = np.flatnonzero(np.abs(tile.depth.ravel()) <= width + 1)
        nearest = _nearest_core(tile, width)
        front = tile.tones.reshape(-1, 3)[nearest]
        # Across the edge the nearest core pixel stays the same: it varies along the edge alone.
        near = np.abs(tile.depth) <= width + 1
        _, varied = _local(front, near, NOISE_REACH, tones_of(np.full(3, 128.0)))
        behind = tile.background.reshape(-1, 3)[band]
        noise = (varied + tile.noise).reshape(-1, 3)[band] / 2 + PICTURE_NOISE**2
        way, off = (tones.reshape(-1, 3)[band] - behind for tones in (front, tile.tones))
        return cls(band, nearest.ravel()[band], way, off, noise)


def tones_of(colours: Floats) -> Floats:
    """Return the brightness, blueness and redness of colours (…, 3)."""
    tones: Floats = colours @ np.array(TONES).T
    return tones


def colours_of(tones: Floats) -> Floats:
    """Return red, green and blue of tones (…, 3)."""
    colours: Floats = tones @ np.linalg.inv(np.array(TONES)).T
    return colours


def fit_alpha(way: Floats, off: Floats, noise: Floats) -> tuple[Floats, Floats]:
    """Return α (n,), the position of pixels along the way, by least squares, and its variance.

    The arguments (n, c) are as in `Mixture`, or some of their channels.
    """
    precision = (way**2 / noise).sum(axis=1)
    alpha = (way * off / noise).sum(axis=1) / np.maximum(precision, 1e-12)
    return alpha, 1 / np.maximum(precision, 1e-12)


def _local(values: Floats, where: Booleans, reach: int, otherwise: Floats) -> tuple[Floats, Floats]:
    """Return the means and variances (h, w, c), within `reach`, of the values marked in `where`.

    If none is within reach, the mean is `otherwise` (c,) and the variance 0.
    """
    weight = ndimage.uniform_filter(where.astype(np.float32), 2 * reach + 1, mode="constant")
    known = weight > 0.5 / (2 * reach + 1) ** 2
    mean, variance = np.empty_like(values), np.zeros_like(values)
    for channel in range(values.shape[2]):
        # Relative to a value in the middle, so that squares keep their digits.
        shifted = np.where(where, values[..., channel] - otherwise[channel], 0.0)
        shifted = shifted.astype(np.float32)
        first, second = (
            ndimage.uniform_filter(power, 2 * reach + 1, mode="constant")
            * known
            / np.where(known, weight, 1.0)
            for power in (shifted, shifted**2)
        )
        mean[..., channel] = otherwise[channel] + first
        variance[..., channel] = np.maximum(second - first**2, 0.0)
    return mean, variance


def _nearest_core(tile: Tile, width: int) -> Indices:
    """Return for each pixel (h, w) the nearest pixel of the pure subject, as a flat index."""
    # Where the subject is thinner than two edges, its middle serves instead.
    reach = ndimage.maximum_filter(tile.depth, 2 * width + 1)
    core = tile.subject & (tile.depth >= np.minimum(width, reach))
    nearest = ndimage.distance_transform_edt(~core, return_distances=False, return_indices=True)
    rows, columns = np.asarray(nearest).reshape(2, *core.shape)
    return np.asarray(rows * core.shape[1] + columns, dtype=np.intp)
