"""Colours under what is transparent, for readers that mix neighbours before they see alpha."""

from typing import Final

import numpy as np
from PIL import Image

from engine.arrays import Bytes

# Sides of the squares whose visible colours fill what is transparent in them, one after the other.
_SQUARES: Final = (4, 16, 64)
_ENOUGH: Final = 16  # levels of alpha, below which a mean of 8 bits has lost its colour


def bleed_edges(frame: Bytes) -> Bytes:
    """Return a picture whose colours go on where it is transparent.

    Textures are enlarged, and video is compressed, with straight alpha: what is not seen there
    darkens the edges of what is.

    Parameters
    ----------
    frame : uint8, shape (h, w, 4)
        Straight alpha.
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
