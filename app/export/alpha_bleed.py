"""Textures of meshes: a part of a picture, with colours under its transparent pixels.

Readers mix neighbouring pixels before they apply alpha.
"""

import math
from typing import Final

import numpy as np
from PIL import Image

from app.motion import bounding_box
from engine.arrays import Bytes, Complexes, Floats, freeze

# Sides of squares in pixels. The visible colours of a square fill its transparent pixels; one pass
# per size.
_SQUARES: Final = (4, 16, 64)
_BORDER: Final = 2  # transparent pixels around a texture: readers repeat its edge
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


def cut_texture(picture: Bytes, vertices: Complexes) -> tuple[Bytes, Floats]:
    """Return the part of a picture inside a mesh, with a border, and the vertices' uv in it.

    The vertices are in pixels from the lower left corner of the picture.
    """
    height, width, _ = picture.shape
    box = bounding_box(vertices)
    left, bottom = (math.floor(side) - _BORDER for side in (box.lower.real, box.lower.imag))
    right, top = (math.ceil(side) + _BORDER for side in (box.upper.real, box.upper.imag))
    texture = np.zeros((top - bottom, right - left, 4), dtype=np.uint8)
    # The mesh may extend beyond the picture.
    x0, x1, y0, y1 = max(left, 0), min(right, width), max(bottom, 0), min(top, height)
    texture[top - y1 : top - y0, x0 - left : x1 - left] = picture[height - y1 : height - y0, x0:x1]
    offsets = vertices - complex(left, bottom)
    uv = np.column_stack([offsets.real / (right - left), offsets.imag / (top - bottom)])
    return texture, freeze(uv)
