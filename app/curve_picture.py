"""The curves of the distortion as a picture."""

import io

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from app.measuring import Curves
from engine.arrays import Floats

SIZE = (1400, 560)
MARGIN, GAP = 70, 60
PAPER, INK, GRID = (255, 255, 255), (60, 64, 74), (224, 226, 232)
LINE, BOUND = (74, 91, 224, 90), (207, 63, 60, 255)
TITLES = ("k, relative to the larger key", "τ − 1, relative to the larger key")


def draw_curves(curves: Curves) -> bytes:
    """Return a PNG of both plots, k on the left and τ on the right; the bound is red."""
    picture = Image.new("RGBA", SIZE, (*PAPER, 255))
    width = (SIZE[0] - 2 * MARGIN - GAP) // 2
    for index, (title, shares) in enumerate(
        zip(TITLES, (curves.k_share, curves.tau_share), strict=True)
    ):
        left = MARGIN + index * (width + GAP)
        box = (left, MARGIN, left + width, SIZE[1] - MARGIN)
        _draw_plot(picture, box, title, curves.frames, shares)
    stream = io.BytesIO()
    picture.convert("RGB").save(stream, "PNG")
    return stream.getvalue()


def _draw_plot(
    picture: Image.Image, box: tuple[int, int, int, int], title: str, frames: Floats, shares: Floats
) -> None:
    left, top, right, bottom = box
    highest = max(1.15, 1.05 * float(shares.max(initial=0.0)))
    first, last = float(frames[0]), float(frames[-1])
    x = left + (frames - first) / max(last - first, 1.0) * (right - left)
    pen = ImageDraw.Draw(picture)
    font = ImageFont.load_default(18)
    for value in np.arange(0.0, highest, 0.25):
        y = bottom - value / highest * (bottom - top)
        pen.line((left, y, right, y), fill=GRID)
        pen.text((left - 8, y), f"{value:g}", fill=INK, font=font, anchor="rm")
    for frame in np.linspace(first, last, 5):
        place = left + (frame - first) / max(last - first, 1.0) * (right - left)
        pen.text((place, bottom + 8), f"{frame:.0f}", fill=INK, font=font, anchor="mt")
    # Lines are laid over each other, so that where many points agree the plot is darker.
    for column in shares.T:
        layer = Image.new("RGBA", picture.size)
        y = bottom - column / highest * (bottom - top)
        points = list(zip(x.tolist(), y.tolist(), strict=True))
        ImageDraw.Draw(layer).line(points, fill=LINE, width=2)
        picture.alpha_composite(layer)
    y = bottom - 1.0 / highest * (bottom - top)
    pen.line((left, y, right, y), fill=BOUND, width=3)
    pen.rectangle(box, outline=INK)
    pen.text((left, top - 12), title, fill=INK, font=font, anchor="lb")
