"""Measurements of the fading of a subject into its background, along its edge."""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from app.cut_out.mixture import HUES, SURE, Mixture, Tile, fit_alpha
from engine.arrays import Booleans, Bytes, Floats, Indices

Part = tuple[slice, slice]  # of a picture: rows and columns

NARROWEST_EDGE, WIDEST_EDGE = 2, 6  # pixels over which the subject fades into the background
PLATEAU = 0.08  # the edge ends where the next pixel inwards differs by a smaller share
MOST_PLACES = 0.8  # of the rim: share of places where the edge is at most as wide as the result
MOST_MEASURED = 8  # tiles in which the edge is measured
MOST_SAMPLED = 4000  # pixels of the rim that are measured
# Beside the edge, α is noise: least number of standard deviations that are removed, the share of
# pixels within the removed range, and a margin.
LEAST_NOISE, MOST_BESIDE, MARGIN = 2.5, 0.99, 1.0
# JPEG stores the last two tones at half the resolution. Their blur counts if it is clear. It is
# measured around α of one half, where brightness determines α well.
MIDDLE, BLURRED, SHARPEST = 0.25, 1.05, 4.0


class SoftEdge(NamedTuple):
    """Measurements of the edge of a whole subject.

    Parameters
    ----------
    width : int
        Pixels over which it fades, inwards from the border of the mask.
    gain : float
        How many times steeper α is in brightness than in blueness and redness.
    disparity : float
        Standard deviation of α by blueness and redness from α by brightness, beyond their noise.
    noise : float
        Standard deviations of α up to which it counts as noise.
    contrast : float
        Usual difference between subject and background, in levels.
    paper : float64, shape (3,)
        The background's colour where none is nearby.
    """

    width: int
    gain: float
    disparity: float
    noise: float
    contrast: float
    paper: Floats


def measure_edge(rgba: Bytes, subject: Booleans, windows: list[tuple[Part, Part]]) -> SoftEdge:
    """Measure the edge of a subject (h, w) of a picture (h, w, 4) on some of the `windows`.

    These are the tiles with a part of the edge, without and with the context around them.
    """
    step = max(1, len(rgba) * rgba.shape[1] // (MOST_SAMPLED * 25))
    paper = np.median(rgba[..., :3][~subject][::step], axis=0).astype(np.float64)
    chosen = windows[:: -(-len(windows) // MOST_MEASURED)]
    tiles = [Tile.of(rgba[outer][..., :3], subject[outer], paper) for _, outer in chosen]
    steps = np.concatenate([_fading(tile) for tile in tiles])
    width = max(NARROWEST_EDGE, int(np.quantile(steps, MOST_PLACES)) + 1) if len(steps) else 2
    mixtures = [Mixture.of(tile, width) for tile in tiles]
    way, off, noise = (
        np.concatenate([getattr(mixture, part) for mixture in mixtures])
        for part in ("way", "off", "noise")
    )
    contrast = np.sqrt((way**2).sum(axis=1))
    gain, error = _sharpening(way, off, noise)
    depth = np.concatenate([t.depth.ravel()[m.band] for t, m in zip(tiles, mixtures, strict=True)])
    edge = SoftEdge(
        width=width,
        gain=gain,
        disparity=error,
        noise=LEAST_NOISE,
        contrast=float(np.median(contrast)) if len(contrast) else 0.0,
        paper=paper,
    )
    beside = depth < -SURE
    if not beside.any():
        return edge
    alpha, variance = fit_alpha(*weigh_hues(way[beside], off[beside], noise[beside], edge))
    largest = float(np.quantile(np.abs(alpha) / np.sqrt(variance), MOST_BESIDE))
    return edge._replace(noise=max(LEAST_NOISE, MARGIN * largest))


def weigh_hues(
    way: Floats, off: Floats, noise: Floats, edge: SoftEdge
) -> tuple[Floats, Floats, Floats]:
    """Return a mixture's parts with hues as sharp as brightness, and with less weight."""
    if edge.gain > 1:
        # Around the middle of the way, and limited to its ends.
        own, _ = fit_alpha(way[:, HUES], off[:, HUES], noise[:, HUES])
        off = mix_hues(way, off, noise, np.clip(0.5 + edge.gain * (own - 0.5), 0, 1))
    noise = noise.copy()
    noise[:, HUES] += edge.disparity**2 * way[:, HUES] ** 2
    return way, off, noise


def mix_hues(way: Floats, off: Floats, noise: Floats, alpha: Floats) -> Floats:
    """Return the differences from the background if the hues were mixed by α (n,)."""
    own, _ = fit_alpha(way[:, HUES], off[:, HUES], noise[:, HUES])
    moved = off.copy()
    moved[:, HUES] += (alpha - own)[:, None] * way[:, HUES]
    return moved


def _fading(tile: Tile) -> Indices:
    """Return the number of pixels over which the subject fades, inwards from each rim pixel.

    The fading ends where the colour ceases to move away from the background's.
    """
    rim = np.argwhere((tile.depth > 0) & (tile.depth < 1.5))
    rim = rim[:: max(1, len(rim) * MOST_MEASURED // MOST_SAMPLED)]
    inwards = np.asarray(np.gradient(tile.depth))[:, rim[:, 0], rim[:, 1]].T
    inwards /= np.maximum(np.linalg.norm(inwards, axis=1), 1e-9)[:, None]
    places = rim[:, None] + np.arange(WIDEST_EDGE + 1)[:, None] * inwards[:, None]
    away = np.sqrt(((tile.tones - tile.background) ** 2).sum(axis=2))
    profile = ndimage.map_coordinates(away, np.moveaxis(places, 2, 0), order=1, mode="nearest")
    rises = np.diff(profile, axis=1) > PLATEAU * profile[:, 1:]
    rises = np.concatenate([rises, np.zeros((len(rises), 1), dtype=np.bool_)], axis=1)
    return np.asarray(np.argmin(rises, axis=1), dtype=np.intp)


def _sharpening(way: Floats, off: Floats, noise: Floats) -> tuple[float, float]:
    """Return how much steeper α is in brightness than in hue, and their remaining difference."""
    bright, _ = fit_alpha(way[:, :1], off[:, :1], noise[:, :1])
    hue, _ = fit_alpha(way[:, HUES], off[:, HUES], noise[:, HUES])
    trust = way[:, 0] ** 2 / noise[:, 0]
    middle = np.abs(hue - 0.5) < MIDDLE
    weight = np.where(middle, trust, 0.0)
    spread = (weight * (hue - 0.5) ** 2).sum()
    if spread < 1.0:  # brightness determines α no better than to one unit
        return 1.0, 0.0
    slope = (weight * (hue - 0.5) * (bright - 0.5)).sum() / spread
    gain = float(min(slope, SHARPEST)) if slope > BLURRED else 1.0
    sharp = np.clip(0.5 + gain * (hue - 0.5), 0, 1)
    weight = np.where((sharp > 0) & (sharp < 1), trust, 0.0)
    total = weight.sum()
    if total < 1.0:
        return gain, 0.0
    # The difference beyond brightness's own noise, whose variance is 1 / trust.
    error = (weight * (np.clip(bright, 0, 1) - sharp) ** 2).sum() / total
    own = np.count_nonzero(weight) / total
    return gain, float(np.sqrt(max(error - own, 0.0)))
