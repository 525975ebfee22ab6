"""Colours under transparent pixels, for readers that mix neighbouring pixels before alpha."""

from typing import Final

import numpy as np
from PIL import Image

from engine.arrays import Bytes

# Sides of squares in pixels. The visible colours of a square fill its transparent pixels; one pass
# per size.
_SQUARES: Final = (4, 16, 64)
_ENOUGH: Final = 16  # levels of alpha; below them a mean of 8 bits loses its colour


def bleed_edges(frame: Bytes) -> Bytes:
    """Return a picture, uint8 (h, w, 4), whose visible colours continue under transparent pixels.

    Textures are enlarged, and video is compressed, with straight alpha. Without the bleed, black
    transparent pixels darken the edges.
    """
    hollow = frame[..., 3] == 0
    if not hollow.any() or hollow.all():
        return frame
    filled = frame.copy()
    height, width = hollow.shape
    premultiplied = Image.fromarray(frame).convert("RGBa")
    for side in _SQUARES:
        means = np.asarray(premultiplied.reduce(side).convert("RGBA"))
        wide = means.repeat(side, axis=0)[:height].repeat(side, axis=1)[:, :width]
        found = hollow & (wide[..., 3] >= _ENOUGH)
        filled[found, :3] = wide[found, :3]
        hollow &= ~found
    seen = frame[frame[..., 3] > 0].astype(np.float64)
    filled[hollow, :3] = np.rint(np.average(seen[:, :3], axis=0, weights=seen[:, 3]))
    return filled
