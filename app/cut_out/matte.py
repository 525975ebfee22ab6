"""The matte of a subject that was cut out of its picture: the opacity of each pixel.

A pixel at the subject's edge shows the colour C = α F + (1 − α) B, a mixture of the subject's F and
the background's B (T. Porter and T. Duff, "Compositing digital images", 1984). B is the colour of
the background nearby, F the colour of the subject where its edge ends. α is the mixture on the line
from B to F that is nearest to C, with each channel weighted by its noise. Where there is more noise
than difference, as in a busy photograph, α follows from the distance to the mask's border instead.
F replaces C, so that nothing of B remains.
"""

from collections.abc import Iterator

import numpy as np
from scipy import ndimage

from app.cut_out.mixture import NEARBY, Mixture, Tile, colours_of, fit_alpha
from app.cut_out.soft_edge import (
    WIDEST_EDGE,
    Part,
    SoftEdge,
    measure_edge,
    mix_hues,
    weigh_hues,
)
from engine.arrays import Booleans, Bytes, Floats, readonly
from engine.domain.mask.parts import SPECK, WITH_CORNERS

TILE = 256  # pixels: side of the square tiles
ROOM = WIDEST_EDGE + NEARBY + 4  # pixels of context around a tile
FAINTEST = 1 / 64  # α from which a pixel's own colour is unmixed
# Standard deviation of the α that follows from the distance to the mask's border, in the middle of
# the edge; at its ends the distance is more certain.
GEOMETRY, SURER = 0.25, 0.6
MOST_NOISE = 0.25  # largest part of α that is removed as noise
# Levels within which an edge pixel of a clearly different subject counts as background, and the α
# up to which it does.
ALIKE, FAINT = 20, 0.049
PLAIN = 0.12  # largest standard deviation of α for that rule
# A subject no wider than its edge is an encoder's artefact below so many levels from the
# background, or below this share of the usual contrast.
CLEAREST_THIN, THIN_SHARE = 30.0, 0.2


def matte_picture(rgba: Bytes, subject: Booleans) -> Bytes:
    """Make the background of a picture transparent.

    Parameters
    ----------
    rgba : uint8, shape (h, w, 4)
        Straight alpha.
    subject : bool, shape (h, w)
        False on the background.

    Returns
    -------
    uint8, shape (h, w, 4)
        Straight alpha: 0 well outside the subject, the picture's own well inside, and mixed at the
        edge in between, where the colours are the subject's alone. Transparent pixels beside the
        edge have its colours too, so that no background bleeds in where the texture is
        interpolated.

    Notes
    -----
    The edge's width, up to 6 pixels, is measured once for the whole picture. Cost: some filters of
    the tiles with a part of the edge, 10 ms for each 256 × 256 pixels.
    """
    if subject.all() or not subject.any():
        return readonly(rgba)
    subject = _remove_specks(subject)
    result = rgba.copy()
    result[..., 3][~subject] = 0
    windows = list(_parts(subject))
    edge = measure_edge(rgba, subject, windows)
    for inner, outer in windows:
        top, left = (part.start - around.start for part, around in zip(inner, outer, strict=True))
        height, width = result[inner].shape[:2]
        within = slice(top, top + height), slice(left, left + width)
        _mix(result[inner], rgba[outer], subject[outer], within, edge)
    return readonly(result)


def _parts(subject: Booleans) -> Iterator[tuple[Part, Part]]:
    """Yield the tiles with a part of the edge, without and with the context around them."""
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


def _mix(result: Bytes, rgba: Bytes, subject: Booleans, inner: Part, edge: SoftEdge) -> None:
    """Unmix the edge in a tile of the result, in place; `inner` is the tile in the pictures."""
    tile = Tile.of(rgba[..., :3], subject, edge.paper)
    mixture = Mixture.of(tile, edge.width)
    if not len(mixture.band):
        return
    alpha = _alpha(tile, mixture, edge)
    pixels = rgba.reshape(-1, 4)[mixture.band].astype(np.float64)
    front = tile.rgb.reshape(-1, 3)[mixture.core]
    behind = colours_of(tile.background.reshape(-1, 3)[mixture.band])
    off = mixture.off
    if edge.gain > 1:
        # Blurred hues are mixed by a separate α; with it no background remains in them.
        off = mix_hues(mixture.way, off, mixture.noise, alpha)
    share = np.maximum(alpha, FAINTEST)[:, None]
    unmixed = np.clip(behind + colours_of(off) / share, 0, 255)
    # The fainter the subject, the less its own pixel counts.
    colour = alpha[:, None] * unmixed + (1 - alpha[:, None]) * front
    whole = rgba.copy()
    whole[~subject, 3] = 0
    flat = whole.reshape(-1, 4)
    flat[mixture.band, :3] = np.round(colour)
    flat[mixture.band, 3] = np.minimum(np.round(255 * alpha), pixels[:, 3])
    result[...] = whole[inner]


def _alpha(tile: Tile, mixture: Mixture, edge: SoftEdge) -> Floats:
    """Return α (n,) of the pixels of a mixture."""
    way = mixture.way
    alpha, variance = fit_alpha(*weigh_hues(way, mixture.off, mixture.noise, edge))
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
    behind = colours_of(tile.background.reshape(-1, 3)[mixture.band])
    own, front = rgb[mixture.band], rgb[mixture.core]
    is_paper = (_levels_between(own, behind) <= ALIKE) | (_levels_between(own, edge.paper) <= ALIKE)
    is_paper &= variance < PLAIN**2
    is_paper &= (_levels_between(front, behind) > 2 * ALIKE) & (depth < edge.width)
    return np.where(is_paper, np.minimum(alpha, FAINT), alpha)


def _levels_between(colours: Floats, others: Floats) -> Floats:
    """Return the largest difference of a channel between colours (n, 3) and others, in levels."""
    levels: Floats = np.abs(colours - others).max(axis=1)
    return levels


def _without_noise(alpha: Floats, least: Floats) -> Floats:
    """Return α (n,) in 0 to 1, rounded to 0 or 1 where the difference is noise."""
    alpha = np.where(alpha < 2 * least, 2 * (alpha - least), alpha)
    alpha = np.where(alpha > 1 - 2 * least, 1 - 2 * (1 - alpha - least), alpha)
    return np.clip(alpha, 0, 1)


def _remove_specks(mask: Booleans) -> Booleans:
    labels, count = ndimage.label(mask, WITH_CORNERS)
    areas = np.bincount(labels.ravel(), minlength=count + 1)
    kept = areas >= SPECK * areas[1:].sum()
    kept[0] = False
    return np.asarray(kept[labels])
