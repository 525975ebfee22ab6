"""The plain background of an opaque picture: a flood of its colour from the border."""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from app.cut_out.cut_out import BackgroundColour
from engine.arrays import Booleans, Bytes, Indices, Integers
from engine.domain.mask.grid import block_factor, reduce_blocks, repeat_blocks
from engine.domain.mask.parts import WITH_CORNERS

WORKING_SIDE = 1400  # pixels: larger pictures are flooded in blocks
COLOUR_BIN = 16  # levels: width of the colour bins in which the border's pixels are counted
CHANNEL_WIDTH = 0.006  # of the diagonal: the flood passes no narrower channel
# Islands that a lossy encoder leaves around edges: they have fewer pixels, no farther from the
# background's colour. JPEG at quality 50 to 95 left 5,404 of them around ten drawings, one larger.
SMALLEST_ISLAND, NOISE_LEVELS = 25, 54
BAND = 512  # rows in one search for islands
VIVID = 48  # levels between a colour's channels: less is white, grey or black
SEEN_WIDTH = 0.002  # of the diagonal: narrower places inside are ignored
NEARBY_STEP, NEARBY_REACH = 8, 5  # pixels, and steps: how far the paper nearby is measured


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Background:
    """The background of an opaque picture.

    Parameters
    ----------
    mask : bool, shape (h, w)
        True on the background.
    enclosed : bool, shape (h, w)
        True on inner places with the colour of the background, or of the background nearby. They
        are wide enough to be visible, and of any width if the colour is vivid.
    agreement : float
        Share of the border's pixels that have the background's colour.
    """

    mask: Booleans
    enclosed: Booleans
    colour: Bytes
    agreement: float

    @property
    def is_vivid(self) -> bool:
        """Whether the colour is far from white, grey and black."""
        return _is_vivid(self.colour)


def flood_background(
    rgb: Bytes, tolerance: int, colour: BackgroundColour | None = None
) -> Background:
    """Find the background of an opaque picture by a flood of its border's colour.

    Parameters
    ----------
    tolerance : int
        Levels by which each channel of a background pixel may differ from the border's colour.
    colour : tuple of int, optional
        Red, green and blue of the background; by default the colour of most of the border.

    Notes
    -----
    White teeth in an open mouth must stay although a thin channel between the lips leads to them,
    yet a thin gap between two legs is background. So the flood runs through wide places only (a
    morphological opening). Then the adjoining thin remains are added, without the places behind
    them. Pictures above 1,400 pixels are flooded in blocks and then refined to pixels. Islands of a
    few pixels that hardly differ from the background are an encoder's noise. Inside, the colour is
    also compared with the background's nearby: a photographed sheet is darker towards its edges,
    and all of its pockets count.
    """
    wanted = _border_colour(rgb) if colour is None else np.array(colour, dtype=np.uint8)
    alike = _alike(rgb, wanted, tolerance)
    agreement = float(_border(alike).mean())
    factor = block_factor(alike.shape, WORKING_SIDE)
    flooded = _flood(reduce_blocks(alike, factor, np.logical_and))
    if factor > 1:
        flooded = _refined(flooded, factor, alike)
    flooded |= _noise(flooded, rgb, wanted)
    enclosed = _pockets(rgb, wanted, tolerance, flooded, alike)
    del alike  # large pictures leave little memory
    if enclosed.any():
        enclosed |= _noise(flooded | enclosed, rgb, wanted)
    if _is_vivid(wanted):
        enclosed |= _alike(rgb, wanted, tolerance) & ~flooded
    return Background(mask=flooded, enclosed=enclosed, colour=wanted, agreement=agreement)


def _is_vivid(colour: Bytes) -> bool:
    return int(np.ptp(colour.astype(int))) >= VIVID


def _refined(blocks: Booleans, factor: int, alike: Booleans) -> Booleans:
    """Return the pixels `alike` in blocks or beside them."""
    near = repeat_blocks(ndimage.binary_dilation(blocks, WITH_CORNERS), factor, alike.shape)
    near &= alike
    return near


def _border(values: np.ndarray) -> np.ndarray:
    """Return the border pixels, all four sides one after the other."""
    return np.concatenate([values[0], values[-1], values[:, 0], values[:, -1]])


def _border_colour(rgb: Bytes) -> Bytes:
    """Return the most frequent colour of the border: the median of its fullest bin."""
    border = _border(rgb)
    bins, members = np.unique(border // COLOUR_BIN, axis=0, return_inverse=True)
    fullest = np.bincount(members.ravel(), minlength=len(bins)).argmax()
    return np.asarray(np.median(border[members.ravel() == fullest], axis=0), dtype=np.uint8)


def _alike(rgb: Bytes, colour: Bytes, tolerance: int) -> Booleans:
    """Mark the pixels within `tolerance` of `colour` in every channel."""
    alike = np.ones(rgb.shape[:2], dtype=np.bool_)
    for channel, level in enumerate(colour.astype(int)):
        values = rgb[..., channel]
        # Compared as uint8: a difference of 20 million pixels would need a wider type.
        alike &= values >= max(level - tolerance, 0)
        alike &= values <= min(level + tolerance, 255)
    return alike


def _noise(background: Booleans, rgb: Bytes, colour: Bytes) -> Booleans:
    """Return the islands in a background that are an encoder's noise."""
    noise = np.zeros_like(background)
    # In bands, since labels take as much memory as pictures do. No island leaves the rows added to
    # a band: an area that does has too many pixels within it already.
    for top in range(0, len(noise), BAND):
        band = slice(max(0, top - SMALLEST_ISLAND), top + BAND + SMALLEST_ISLAND)
        inner = slice(top - band.start, top - band.start + BAND)
        noise[top : top + BAND] = _noise_in(background[band], rgb[band], colour)[inner]
    return noise


def _noise_in(background: Booleans, rgb: Bytes, colour: Bytes) -> Booleans:
    labels, _ = ndimage.label(~background, WITH_CORNERS)
    places = np.flatnonzero(~background)
    islands = labels.ravel()[places]
    is_noise = np.bincount(islands, minlength=1) < SMALLEST_ISLAND
    noise = np.zeros_like(background)
    places = places[is_noise[islands]]
    islands = labels.ravel()[places]
    faint = _alike(rgb.reshape(-1, 3)[places][None], colour, NOISE_LEVELS)[0]
    is_noise[islands[~faint]] = False
    noise.ravel()[places] = is_noise[islands]
    return noise


def _flood(alike: Booleans) -> Booleans:
    """Flood pixels `alike` from the border, through no narrow channel."""
    radius = max(1.0, CHANNEL_WIDTH / 2 * float(np.hypot(*alike.shape)))
    wide = _opened(alike, radius)
    frame = np.ones_like(wide)
    frame[1:-1, 1:-1] = False
    flooded = _keep_touching(wide, frame)
    thin = alike & ~wide
    return flooded | _keep_touching(thin | flooded, flooded) & thin


def _pockets(
    rgb: Bytes, colour: Bytes, tolerance: int, flooded: Booleans, alike: Booleans
) -> Booleans:
    """Return the places outside the flood that look like it."""
    pockets = alike & ~flooded
    if flooded.any():
        # A pixel within the tolerance of a flooded pixel is within twice the tolerance of the
        # colour.
        near = _alike(rgb, colour, 2 * tolerance) & ~flooded & ~pockets
        rows, columns = np.nonzero(near)
        apart = np.abs(rgb[rows, columns] - _nearby(rgb, flooded, rows, columns))
        near[rows, columns] = (apart <= tolerance).all(axis=1)
        pockets |= near
    if not pockets.any():
        return pockets
    factor = block_factor(pockets.shape, WORKING_SIDE)
    blocks = reduce_blocks(pockets, factor, np.logical_and)
    width = max(1, round(SEEN_WIDTH * float(np.hypot(*blocks.shape))))
    seen = _keep_touching(blocks, ndimage.minimum_filter(blocks, width, mode="constant"))
    return _refined(seen, factor, pockets) if factor > 1 else seen


def _nearby(rgb: Bytes, flooded: Booleans, rows: Indices, columns: Indices) -> Integers:
    """Return the colour (n, 3) of the flooded background that is nearest to each of n pixels."""
    step = NEARBY_STEP if flooded[::NEARBY_STEP, ::NEARBY_STEP].any() else 1
    sheet, paper = rgb[::step, ::step], flooded[::step, ::step]
    nearest = ndimage.distance_transform_edt(~paper, return_distances=False, return_indices=True)
    at = tuple(nearest[:, rows // step, columns // step])
    weight = ndimage.uniform_filter(paper.astype(np.float64), NEARBY_REACH)[at]
    sums = (np.where(paper, sheet[..., channel], 0.0) for channel in range(3))
    means = [ndimage.uniform_filter(each, NEARBY_REACH)[at] / weight for each in sums]
    nearby: Integers = np.rint(np.column_stack(means)).astype(np.int32)
    return nearby


def _opened(area: Booleans, radius: float) -> Booleans:
    """Return the points that discs of `radius` reach inside the area.

    The area extends past the border of the picture.
    """
    padding = int(np.ceil(radius)) + 1
    padded = np.pad(area, padding, constant_values=True)
    core = ndimage.distance_transform_edt(padded) > radius
    if not core.any():
        return np.zeros_like(area)
    opened = ndimage.distance_transform_edt(~core) <= radius
    inner = slice(padding, -padding)
    return area & opened[inner, inner]


def _keep_touching(area: Booleans, seeds: Booleans) -> Booleans:
    """Return the components of `area`, connected by edges, that have a seed."""
    labels, count = ndimage.label(area)
    chosen = np.zeros(count + 1, dtype=np.bool_)
    chosen[labels[seeds]] = True
    chosen[0] = False
    return np.asarray(chosen[labels])
