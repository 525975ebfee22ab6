"""The matte of a subject that was cut out of its picture: how opaque each of its pixels is.

A pixel at the subject's edge shows the colour C = α F + (1 − α) B, a mixture of the subject's F and
the background's B (T. Porter and T. Duff, "Compositing digital images", 1984). B is what the
background shows nearby, F what the subject shows where its edge ends; α is the mixture on the way
from B to F that is nearest to C, each channel weighed by its noise. Where there is more noise than
difference, as in a busy photograph, the distance from the mask's border tells α instead. F takes
the place of C, so that nothing of B is left.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from scipy import ndimage

from engine.arrays import Booleans, Bytes, Floats, Indices, readonly
from engine.domain.picture.parts import without_specks

NARROWEST_EDGE, WIDEST_EDGE = 2, 6  # pixels over which the subject fades into the background
PLATEAU = 0.08  # where the next pixel inwards differs by a smaller share, the edge ends
MOST_PLACES = 0.8  # of the rim: where the edge is at most as wide as is measured
NEARBY = 8  # pixels within which the background's colour is taken
TILE = 256  # pixels: side of the squares that are worked on one after the other
ROOM = WIDEST_EDGE + NEARBY + 4  # pixels around a tile that are looked at
MOST_MEASURED = 8  # tiles on which the edge is measured
MOST_SAMPLED = 4000  # pixels of the rim likewise
SURE = 2.0  # pixels off the mask from which on a pixel is background alone
NOISE_REACH = 2  # pixels: what is varied within is noise
FAINTEST = 1 / 64  # α from which on a pixel's own colour is unmixed
# Standard deviation of what the distance from the mask's border tells of α in the middle of the
# edge; at its ends, it is surer.
GEOMETRY, SURER = 0.25, 0.6
# Beside the edge, α is noise: standard deviations of it that are taken away at least, the share of
# pixels that lies within what is taken away, a margin, and how much of α that is at most.
LEAST_NOISE, MOST_BESIDE, MARGIN, MOST_NOISE = 2.5, 0.99, 1.0, 0.25
# Levels within which a pixel at the edge of a subject that clearly differs is background: so faint.
ALIKE, FAINT = 20, 0.049
PLAIN = 0.12  # standard deviation of α up to which that is believed
# Levels between subject and background below which a subject that is no wider than its edge is
# taken for what an encoder leaves around one; and the share of the usual contrast.
CLEAREST_THIN, THIN_SHARE = 30.0, 0.2
# Brightness, blueness, redness of red, green, blue.
TONES = ((0.299, 0.587, 0.114), (-0.169, -0.331, 0.5), (0.5, -0.419, -0.081))
HUES = (1, 2)  # which of them are the last two
ROUNDING = 0.5  # levels of noise that every picture has
# JPEG stores the last two tones at half the resolution: how much they are blurred, if clearly, is
# measured where α is about one half, if brightness tells it well enough.
MIDDLE, BLURRED, SHARPEST = 0.25, 1.05, 4.0


class _Edge(NamedTuple):
    """What is measured of the edge of a whole subject.

    Parameters
    ----------
    width : int
        Pixels over which it fades, inwards from the border of the mask.
    gain : float
        How many times steeper α is in brightness than in blueness and redness.
    disparity : float
        Standard deviation of α by blueness and redness from α by brightness, beyond their noise.
    noise : float
        Standard deviations of α beyond which it is none.
    contrast : float
        Levels between subject and background that are usual.
    paper : float64, shape (3,)
        The background's colour where none is nearby.
    """

    width: int
    gain: float
    disparity: float
    noise: float
    contrast: float
    paper: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Tile:
    """A part of a picture with some room around it.

    Parameters
    ----------
    rgb, tones : float64, shape (h, w, 3)
        Colours, and their brightness, blueness and redness.
    subject : bool, shape (h, w)
    depth : float64, shape (h, w)
        Distance of each pixel of the subject from the background, and of each of the background
        from the subject as a negative number, in pixels; ±1 next to the border between them.
    background, noise : float64, shape (h, w, 3)
        Mean and variance of its tones nearby.
    """

    rgb: Floats
    tones: Floats
    subject: Booleans
    depth: Floats
    background: Floats
    noise: Floats

    @classmethod
    def of(cls, rgb: Bytes, subject: Booleans, paper: Floats) -> Self:
        colours = rgb.astype(np.float64)
        tones = _tones(colours)
        inside = ndimage.distance_transform_edt(subject)
        depth = inside - ndimage.distance_transform_edt(~subject)
        sure = depth < -SURE
        if not sure.any():
            sure = depth < 0
        background, noise = _local(tones, sure, NEARBY, _tones(paper))
        return cls(
            rgb=colours,
            tones=tones,
            subject=subject,
            depth=depth,
            background=background,
            noise=noise,
        )


class _Mixture(NamedTuple):
    """The pixels (n,) at the edge, as flat indices of a tile, and what they are mixed of.

    Parameters
    ----------
    band, core : int64
        The pixels, and those nearest to them where the subject is pure.
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


def _tones(colours: Floats) -> Floats:
    """Return the brightness, blueness and redness of colours (…, 3)."""
    tones: Floats = colours @ np.array(TONES).T
    return tones


def _colours(tones: Floats) -> Floats:
    """Return red, green and blue of tones (…, 3)."""
    colours: Floats = tones @ np.linalg.inv(np.array(TONES)).T
    return colours


def matted(rgba: Bytes, subject: Booleans) -> Bytes:
    """Make what is not the subject of a picture transparent.

    Parameters
    ----------
    rgba : uint8, shape (h, w, 4)
        Straight alpha.
    subject : bool, shape (h, w)
        False on the background.

    Returns
    -------
    uint8, shape (h, w, 4)
        Straight alpha: 0 well outside the subject, the picture's own well inside, and at the edge
        in between, where the colours are the subject's alone. Transparent pixels beside the edge
        have its colours too, so that none bleeds in where the texture is interpolated.

    Notes
    -----
    The edge's width is measured, up to 6 pixels, and one for the whole picture. Cost: some filters
    of the tiles through which the edge runs, 10 ms for each 256 × 256 pixels.
    """
    if subject.all() or not subject.any():
        return readonly(rgba)
    subject = without_specks(subject)
    result = rgba.copy()
    result[..., 3][~subject] = 0
    windows = list(_parts(subject))
    edge = _measured(rgba, subject, windows)
    for inner, outer in windows:
        _mix(result[inner], rgba[outer], subject[outer], _within(inner, outer), edge)
    return readonly(result)


_Part = tuple[slice, slice]


def _parts(subject: Booleans) -> Iterator[tuple[_Part, _Part]]:
    """Yield the tiles at or through which the edge runs, without and with the room around them."""
    height, width = subject.shape
    for top in range(0, height, TILE):
        for left in range(0, width, TILE):
            bottom, right = min(top + TILE, height), min(left + TILE, width)
            outer = (
                slice(max(0, top - ROOM), min(height, bottom + ROOM)),
                slice(max(0, left - ROOM), min(width, right + ROOM)),
            )
            window = subject[outer]
            if window.any() and not window.all():
                yield (slice(top, bottom), slice(left, right)), outer


def _within(inner: _Part, outer: _Part) -> _Part:
    rows, columns = (
        slice(part.start - around.start, part.stop - around.start)
        for part, around in zip(inner, outer, strict=True)
    )
    return rows, columns


def _local(values: Floats, where: Booleans, reach: int, otherwise: Floats) -> tuple[Floats, Floats]:
    """Return the means and variances (h, w, c), within `reach`, of the values `where` they count.

    Where none is within reach, the mean is `otherwise` (c,) and the variance 0.
    """
    weight = ndimage.uniform_filter(where.astype(np.float32), 2 * reach + 1, mode="constant")
    known = weight > 0.5 / (2 * reach + 1) ** 2
    mean, variance = np.empty_like(values), np.zeros_like(values)
    for channel in range(values.shape[2]):
        # Around a value in the middle, so that squares keep their digits.
        shifted = np.where(where, values[..., channel] - otherwise[channel], 0.0)
        shifted = shifted.astype(np.float32)
        sums = [
            ndimage.uniform_filter(power, 2 * reach + 1, mode="constant")
            / np.where(known, weight, 1.0)
            for power in (shifted, shifted**2)
        ]
        first, second = (np.where(known, moment, 0.0) for moment in sums)
        mean[..., channel] = otherwise[channel] + first
        variance[..., channel] = np.maximum(second - first**2, 0.0)
    return mean, variance


def _measured(rgba: Bytes, subject: Booleans, windows: list[tuple[_Part, _Part]]) -> _Edge:
    """Measure the edge on some of the tiles."""
    step = max(1, len(rgba) * rgba.shape[1] // (MOST_SAMPLED * 25))
    paper = np.median(rgba[..., :3][~subject][::step], axis=0).astype(np.float64)
    chosen = windows[:: -(-len(windows) // MOST_MEASURED)]
    tiles = [_Tile.of(rgba[outer][..., :3], subject[outer], paper) for _, outer in chosen]
    steps = np.concatenate([_fading(tile) for tile in tiles])
    width = max(NARROWEST_EDGE, int(np.quantile(steps, MOST_PLACES)) + 1) if len(steps) else 2
    mixtures = [_mixture(tile, width) for tile in tiles]
    way, off, noise = (
        np.concatenate([getattr(mixture, part) for mixture in mixtures])
        for part in ("way", "off", "noise")
    )
    contrast = np.sqrt((way**2).sum(axis=1))
    gain, error = _sharpening(way, off, noise)
    depth = np.concatenate([t.depth.ravel()[m.band] for t, m in zip(tiles, mixtures, strict=True)])
    edge = _Edge(
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
    alpha, variance = _along(*_weighed(way[beside], off[beside], noise[beside], edge))
    largest = float(np.quantile(np.abs(alpha) / np.sqrt(variance), MOST_BESIDE))
    return edge._replace(noise=max(LEAST_NOISE, MARGIN * largest))


def _fading(tile: _Tile) -> Indices:
    """Return over how many pixels the subject fades, inwards from each pixel of its rim.

    That is where the colour ceases to move away from the background's.
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
    """Return how much steeper α is in brightness than in hue, and how far they differ then."""
    bright, _ = _along(way[:, :1], off[:, :1], noise[:, :1])
    hue, _ = _along(way[:, HUES], off[:, HUES], noise[:, HUES])
    trust = way[:, 0] ** 2 / noise[:, 0]
    middle = np.abs(hue - 0.5) < MIDDLE
    weight = np.where(middle, trust, 0.0)
    spread = (weight * (hue - 0.5) ** 2).sum()
    if spread < 1.0:  # brightness tells less than one value of α
        return 1.0, 0.0
    slope = (weight * (hue - 0.5) * (bright - 0.5)).sum() / spread
    gain = float(min(slope, SHARPEST)) if slope > BLURRED else 1.0
    sharp = np.clip(0.5 + gain * (hue - 0.5), 0, 1)
    weight = np.where((sharp > 0) & (sharp < 1), trust, 0.0)
    total = weight.sum()
    if total < 1.0:
        return gain, 0.0
    # What is left beyond brightness's own noise, whose variance is 1 / trust.
    error = (weight * (np.clip(bright, 0, 1) - sharp) ** 2).sum() / total
    own = np.count_nonzero(weight) / total
    return gain, float(np.sqrt(max(error - own, 0.0)))


def _along(way: Floats, off: Floats, noise: Floats) -> tuple[Floats, Floats]:
    """Return α (n,) by least squares over channels (n, c), and its variance."""
    precision = (way**2 / noise).sum(axis=1)
    alpha = (way * off / noise).sum(axis=1) / np.maximum(precision, 1e-12)
    return alpha, 1 / np.maximum(precision, 1e-12)


def _mixture(tile: _Tile, width: int) -> _Mixture:
    band = np.flatnonzero(np.abs(tile.depth.ravel()) <= width + 1)
    nearest = _nearest_core(tile, width)
    front = tile.tones.reshape(-1, 3)[nearest]
    # Across the edge the nearest one stays the same: it varies along the edge alone.
    near = np.abs(tile.depth) <= width + 1
    _, varied = _local(front, near, NOISE_REACH, _tones(np.full(3, 128.0)))
    behind = tile.background.reshape(-1, 3)[band]
    noise = (varied + tile.noise).reshape(-1, 3)[band] / 2 + ROUNDING**2
    core = nearest.ravel()[band]
    return _Mixture(
        band=band,
        core=core,
        way=front.reshape(-1, 3)[band] - behind,
        off=tile.tones.reshape(-1, 3)[band] - behind,
        noise=noise,
    )


def _nearest_core(tile: _Tile, width: int) -> Indices:
    """Return the pixel (h, w), as a flat index, nearest to each where the subject is pure."""
    # Where the subject is thinner than two edges, its middle has to do.
    reach = ndimage.maximum_filter(tile.depth, 2 * width + 1)
    core = tile.subject & (tile.depth >= np.minimum(width, reach))
    nearest = ndimage.distance_transform_edt(~core, return_distances=False, return_indices=True)
    rows, columns = np.asarray(nearest).reshape(2, *core.shape)
    return np.asarray(rows * core.shape[1] + columns, dtype=np.intp)


def _mix(result: Bytes, rgba: Bytes, subject: Booleans, inner: _Part, edge: _Edge) -> None:
    """Unmix the edge in a tile of the result, in place; `inner` is where it lies in the others."""
    tile = _Tile.of(rgba[..., :3], subject, edge.paper)
    mixture = _mixture(tile, edge.width)
    if not len(mixture.band):
        return
    alpha = _alpha(tile, mixture, edge)
    pixels = rgba.reshape(-1, 4)[mixture.band].astype(np.float64)
    front = tile.rgb.reshape(-1, 3)[mixture.core]
    behind = _colours(tile.background.reshape(-1, 3)[mixture.band])
    off = mixture.off
    if edge.gain > 1:
        # Blurred hues are mixed by an α of their own: by that, no background is left in them.
        off = _with_hue_mixed(mixture.way, off, mixture.noise, alpha)
    share = np.maximum(alpha, FAINTEST)[:, None]
    unmixed = np.clip(behind + _colours(off) / share, 0, 255)
    # The fainter the subject, the less does its own pixel tell of it.
    colour = alpha[:, None] * unmixed + (1 - alpha[:, None]) * front
    whole = rgba.copy()
    whole[~subject, 3] = 0
    flat = whole.reshape(-1, 4)
    flat[mixture.band, :3] = np.round(colour)
    flat[mixture.band, 3] = np.minimum(np.round(255 * alpha), pixels[:, 3])
    result[...] = whole[inner]


def _weighed(way: Floats, off: Floats, noise: Floats, edge: _Edge) -> tuple[Floats, Floats, Floats]:
    """Return the parts of a mixture with its hues made as sharp as brightness, and less trusted."""
    if edge.gain > 1:
        # Around the middle of the way, and no farther than its ends.
        own, _ = _along(way[:, HUES], off[:, HUES], noise[:, HUES])
        off = _with_hue_mixed(way, off, noise, np.clip(0.5 + edge.gain * (own - 0.5), 0, 1))
    noise = noise.copy()
    noise[:, HUES] += edge.disparity**2 * way[:, HUES] ** 2
    return way, off, noise


def _with_hue_mixed(way: Floats, off: Floats, noise: Floats, alpha: Floats) -> Floats:
    """Return where pixels are off the background if their hues were mixed by α (n,)."""
    own, _ = _along(way[:, HUES], off[:, HUES], noise[:, HUES])
    moved = off.copy()
    moved[:, HUES] += (alpha - own)[:, None] * way[:, HUES]
    return moved


def _alpha(tile: _Tile, mixture: _Mixture, edge: _Edge) -> Floats:
    """Return α (n,) of the pixels of a mixture."""
    way = mixture.way
    alpha, variance = _along(*_weighed(way, mixture.off, mixture.noise, edge))
    depth = tile.depth.ravel()[mixture.band]
    guess = np.clip((depth + 0.5) / edge.width, 0, 1)
    solid = tile.depth.ravel()[mixture.core] >= edge.width
    length = np.sqrt((way**2).sum(axis=1))
    is_speck = ~solid & (length < max(CLEAREST_THIN, THIN_SHARE * edge.contrast))
    guess, variance = np.where(is_speck, 0.0, guess), np.where(is_speck, np.inf, variance)
    prior = GEOMETRY * (1 - SURER * np.abs(2 * guess - 1))
    trust = prior**2 / (prior**2 + variance)
    alpha = guess + trust * (np.clip(alpha, -0.5, 1.5) - guess)
    deviation = prior * np.sqrt(1 - trust)
    alpha = _without_noise(alpha, np.minimum(edge.noise * deviation, MOST_NOISE))
    rgb = tile.rgb.reshape(-1, 3)
    behind = _colours(tile.background.reshape(-1, 3)[mixture.band])
    own, front = rgb[mixture.band], rgb[mixture.core]
    is_paper = (_levels_between(own, behind) <= ALIKE) | (_levels_between(own, edge.paper) <= ALIKE)
    is_paper &= variance < PLAIN**2
    is_paper &= (_levels_between(front, behind) > 2 * ALIKE) & (depth < edge.width)
    return np.where(is_paper, np.minimum(alpha, FAINT), alpha)


def _levels_between(colours: Floats, others: Floats) -> Floats:
    """Return by how many levels colours (n, 3) differ from others in their most different one."""
    levels: Floats = np.abs(colours - others).max(axis=1)
    return levels


def _without_noise(alpha: Floats, least: Floats) -> Floats:
    """Return α (n,) from 0 to 1, and either of them where it differs by no more than noise."""
    alpha = np.where(alpha < 2 * least, 2 * (alpha - least), alpha)
    alpha = np.where(alpha > 1 - 2 * least, 1 - 2 * (1 - alpha - least), alpha)
    return np.clip(alpha, 0, 1)
