"""Paint: forms with colour, marks, light and an ink outline, on a transparent canvas.

The light of all pictures comes from the upper left. Every form is lit as if it were inflated to a
round body, in soft steps, as in a cel animation.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.sparse
from curves import Points, ribbon
from numpy.typing import NDArray
from PIL import Image, ImageColor, ImageDraw
from scipy.ndimage import gaussian_filter, map_coordinates
from scipy.sparse.linalg import spsolve
from shapely.affinity import translate
from shapely.geometry.base import BaseGeometry

Pixels = NDArray[np.float32]

INK = "#2b1b38"
_LIGHT = np.array([-0.46, -0.66, 0.59])
_SHADOW = np.array([0.71, 0.59, 0.69])
_GLOW = np.array([1.0, 0.97, 0.86])
_BOUNCE = np.array([0.72, 0.78, 1.0])

_SUPERSAMPLE = 8
_MARGIN = 0.04
_MAX_UNKNOWNS = 40_000


def rgb(colour: str) -> NDArray[np.float64]:
    """The colour "#rrggbb" as three numbers from 0 to 1."""
    return np.array(ImageColor.getrgb(colour)[:3]) / 255


@dataclass(frozen=True, slots=True)
class Gradient:
    """A colour that changes evenly from one point to another, and stays constant beyond them."""

    start: complex
    end: complex
    first: str
    last: str


@dataclass(frozen=True, slots=True)
class Mark:
    """Something painted on a form, under its light: a patch, a cheek, a cast shadow."""

    shape: BaseGeometry
    colour: str | Gradient
    opacity: float = 1.0
    blur: float = 0.0


@dataclass(frozen=True, slots=True)
class _Window:
    """A rectangle of whole pixels of the canvas."""

    left: int
    top: int
    right: int
    bottom: int

    def around(self, shape: BaseGeometry, pad: float) -> _Window:
        """The part of this window within `pad` pixels of the box around `shape`."""
        left, top, right, bottom = shape.bounds
        # Of a window that misses the shape, nothing remains.
        return _Window(
            left=min(max(self.left, int(left - pad)), self.right),
            top=min(max(self.top, int(top - pad)), self.bottom),
            right=max(min(self.right, int(right + pad) + 2), self.left),
            bottom=max(min(self.bottom, int(bottom + pad) + 2), self.top),
        )

    def within(self, outer: _Window) -> tuple[slice, slice]:
        """Slices of this window in the arrays of a larger one."""
        rows = slice(self.top - outer.top, self.bottom - outer.top)
        return rows, slice(self.left - outer.left, self.right - outer.left)

    def coverage(self, shape: BaseGeometry) -> Pixels:
        """Share of every pixel that `shape` covers, float32 (h, w)."""
        scale = _SUPERSAMPLE
        size = (self.right - self.left, self.bottom - self.top)
        fine = Image.new("L", (size[0] * scale, size[1] * scale))
        draw = ImageDraw.Draw(fine)
        corner = np.array([self.left, self.top])
        for part in getattr(shape, "geoms", [shape]):
            if part.geom_type != "Polygon":
                continue
            for rim, value in [(part.exterior, 255), *((hole, 0) for hole in part.interiors)]:
                # Pillow's pixel centres lie on whole numbers.
                points = (np.asarray(rim.coords) - corner) * scale - 0.5
                draw.polygon(points.ravel().tolist(), fill=value)
        return np.asarray(fine.reduce(scale), dtype=np.float32) / np.float32(255)

    def colours(self, colour: str | Gradient) -> NDArray[np.float64]:
        """Colours of the pixels, broadcastable to (h, w, 3)."""
        if isinstance(colour, str):
            return rgb(colour)
        x = np.arange(self.left, self.right) + 0.5
        y = np.arange(self.top, self.bottom)[:, None] + 0.5
        way = colour.end - colour.start
        share = ((x + 1j * y - colour.start) * way.conjugate()).real / abs(way) ** 2
        share = np.clip(share, 0.0, 1.0)[..., None]
        return rgb(colour.first) * (1 - share) + rgb(colour.last) * share


def _step(low: float, high: float, value: NDArray[np.float64]) -> NDArray[np.float64]:
    """Smooth step from 0 at `low` to 1 at `high`."""
    share = np.clip((value - low) / (high - low), 0.0, 1.0)
    return share**2 * (3 - 2 * share)


def _inflate(mask: Pixels, step: int) -> NDArray[np.float64]:
    """Inflate a mask to a round body.

    Solves Laplace(h) = -1 with h = 0 outside the mask; sqrt(2h) is then the exact half circle over
    a straight band, whatever its width.

    Parameters
    ----------
    mask : float32 (h, w)
    step : int
        Side of the grid cells in pixels.

    Returns
    -------
    float64 (h, w)
        h, in square pixels.
    """
    rows, columns = (-(-side // step) for side in mask.shape)
    padded = np.zeros((rows * step, columns * step))
    padded[: mask.shape[0], : mask.shape[1]] = mask
    coarse = padded.reshape(rows, step, columns, step).mean(axis=(1, 3))
    inside = np.flatnonzero(coarse)

    def second_difference(count: int) -> scipy.sparse.dia_array:
        ones = np.ones(count)
        return scipy.sparse.diags_array((-ones[1:], 2 * ones, -ones[1:]), offsets=(-1, 0, 1))

    down = scipy.sparse.kron(second_difference(rows), scipy.sparse.eye_array(columns))
    across = scipy.sparse.kron(scipy.sparse.eye_array(rows), second_difference(columns))
    # Cells on the rim are held down by a spring, the stiffer the less of them is inside.
    spring = scipy.sparse.diags_array(1 / coarse.ravel()[inside] - 1)
    height = np.zeros(coarse.size)
    matrix = (down + across).tocsr()[inside][:, inside] + spring
    height[inside] = spsolve(matrix.tocsc(), np.ones(len(inside)))
    y = (np.arange(mask.shape[0]) + 0.5) / step - 0.5
    x = (np.arange(mask.shape[1]) + 0.5) / step - 0.5
    places = np.meshgrid(y, x, indexing="ij")
    fine: NDArray[np.float64] = map_coordinates(
        height.reshape(rows, columns), places, order=3, mode="nearest"
    )
    return step**2 * np.maximum(fine, 0.0)


def _lambert(mask: Pixels) -> NDArray[np.float64]:
    """Cosine between the light and the normal of the inflated `mask`, float64 (h, w)."""
    step = max(1, int(np.ceil(np.sqrt(mask.sum() / _MAX_UNKNOWNS))))
    height = _inflate(mask, step)
    down, across = np.gradient(height)
    normal = np.stack((-across, -down, np.sqrt(2 * height) + 1e-3), axis=-1)
    cosine = normal @ _LIGHT / np.linalg.norm(normal, axis=-1)
    # The grid cells that the rim cuts are not to be trusted: continue from further inside.
    trust = np.clip(2 * gaussian_filter(mask, step) - 1, 0.0, 1.0) ** 2 + 1e-4 * mask
    blur = 1.5 * step
    filled: NDArray[np.float64] = gaussian_filter(trust * cosine, blur)
    filled /= gaussian_filter(trust, blur) + 1e-9
    return filled


def _lit(colours: NDArray[np.float64], mask: Pixels, gloss: float) -> NDArray[np.float64]:
    """Light `colours` (h, w, 3) as the surface of the inflated `mask`."""
    lambert = _lambert(mask)
    shadow = (1 - _step(-0.08, 0.12, lambert))[..., None]
    penumbra = (1 - _step(-0.1, 0.6, lambert))[..., None]
    bounce = (1 - _step(-0.8, -0.45, lambert))[..., None]
    glow = _step(0.88, 0.98, lambert)[..., None]
    lit: NDArray[np.float64] = colours * (1 - (0.5 * shadow + 0.25 * penumbra) * (1 - _SHADOW))
    lit += 0.14 * bounce * (_BOUNCE - lit)
    lit += gloss * glow * (_GLOW - lit)
    return lit


def _straight(pixels: Pixels) -> NDArray[np.uint8]:
    """Colours that are multiplied by alpha as straight ones, uint8 (h, w, 4)."""
    image = np.zeros(pixels.shape, dtype=np.uint8)
    image[..., 3] = np.rint(255 * pixels[..., 3])
    visible = image[..., 3] > 0
    colours = pixels[visible, :3] / pixels[visible, 3:]
    image[visible, :3] = np.rint(255 * np.clip(colours, 0.0, 1.0))
    return image


class Canvas:
    """A transparent picture that grows form by form, from the back to the front.

    Colours are kept multiplied by alpha, so that reduced and blended edges have no fringes.
    """

    def __init__(self, width: int, height: int) -> None:
        self._frame = _Window(left=0, top=0, right=width, bottom=height)
        self._pixels: Pixels = np.zeros((height, width, 4), dtype=np.float32)

    def _blend(self, window: _Window, colours: NDArray[np.float64], alpha: Pixels) -> None:
        target = self._pixels[window.within(self._frame)]
        alpha = alpha[..., None]
        target *= 1 - alpha
        target[..., :3] += colours * alpha
        target[..., 3:] += alpha

    def flat(self, shape: BaseGeometry, colour: str | Gradient) -> None:
        """Fill `shape` evenly, without light or ink."""
        window = self._frame.around(shape, 1)
        self._blend(window, window.colours(colour), window.coverage(shape))

    def form(
        self,
        shape: BaseGeometry,
        colour: str | Gradient,
        *marks: Mark,
        ink: float = 6.0,
        gloss: float = 0.35,
        dim: float = 0.0,
    ) -> None:
        """Paint a lit form with its marks and an ink outline.

        Parameters
        ----------
        shape : shapely geometry
        colour : str or Gradient
        marks : Mark
            Painted in order, each clipped to `shape`.
        ink : float
            Width of the outline in pixels, a little more on the side away from the light.
        gloss : float
            Strength of the highlight towards the light.
        dim : float
            How far, from 0 to 1, the whole form lies in the shade, as limbs behind a body do.
        """
        if ink:
            line = shape.buffer(ink, quad_segs=16)
            self.flat(line.union(translate(line, 0.2 * ink, 0.3 * ink)), INK)
        window = self._frame.around(shape, 8)
        mask = window.coverage(shape)
        colours = np.broadcast_to(window.colours(colour), (*mask.shape, 3)).copy()
        for mark in marks:
            part = window.around(mark.shape, 3 * mark.blur + 1)
            share = mark.opacity * part.coverage(mark.shape)
            share = (gaussian_filter(share, mark.blur) if mark.blur else share)[..., None]
            target = colours[part.within(window)]
            target += share * (part.colours(mark.colour) - target)
        lit = _lit(colours, mask, gloss) * (1 - dim * (1 - _SHADOW))
        self._blend(window, lit, mask)

    def line(self, points: Points, width: float, colour: str = INK) -> None:
        """Draw a pen line that swells to `width` in its middle and tapers to both ends."""
        swell = np.sin(np.linspace(0.0, np.pi, len(points)))
        self.flat(ribbon(points, width * (0.35 + 0.65 * swell)).shape, colour)

    def layer(self) -> Image.Image:
        """The whole canvas with straight alpha, as a layer of a larger drawing."""
        return Image.fromarray(_straight(self._pixels))

    def image(self) -> Image.Image:
        """The picture with straight alpha, cropped to the subject and an even margin."""
        alpha = np.rint(255 * self._pixels[..., 3]).astype(np.uint8)
        rows, columns = np.flatnonzero(alpha.any(axis=1)), np.flatnonzero(alpha.any(axis=0))
        size = (rows[-1] - rows[0] + 1, columns[-1] - columns[0] + 1)
        margin = round(_MARGIN * max(size))
        image = np.zeros((size[0] + 2 * margin, size[1] + 2 * margin, 4), dtype=np.uint8)
        subject = self._pixels[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        image[margin:-margin, margin:-margin] = _straight(subject)
        return Image.fromarray(image)

    def save(self, path: Path) -> None:
        """Write the picture as a PNG file."""
        self.image().save(path, optimize=True)
