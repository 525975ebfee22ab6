"""A plot of the distortion curves."""

import io

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from app.reports.curves import Curves
from app.texts import _
from engine.arrays import Floats

SIZE = (1400, 560)
FINER = 2  # drawn at this scale and reduced, for smooth lines
MARGIN, GAP, TYPE = FINER * 70, FINER * 60, FINER * 18
PAPER, INK, GRID = (255, 255, 255), (60, 64, 74), (224, 226, 232)
LINE, BOUND = (74, 91, 224), (207, 63, 60)
OPACITY = 0.3  # of one curve
# The font has no Greek letters.
TITLES = (_("k, relative to the larger key"), _("tau - 1, relative to the larger key"))


def draw_curves(curves: Curves) -> bytes:
    """Return a PNG of both plots, k on the left and τ on the right; the limit is red."""
    picture = Image.new("RGB", (FINER * SIZE[0], FINER * SIZE[1]), PAPER)
    width = (picture.width - 2 * MARGIN - GAP) // 2
    for index, (title, shares) in enumerate(
        zip(TITLES, (curves.k_share, curves.tau_share), strict=True)
    ):
        left = MARGIN + index * (width + GAP)
        box = (left, MARGIN, left + width, picture.height - MARGIN)
        _draw_plot(picture, box, title, curves.frames, shares)
    stream = io.BytesIO()
    picture.resize(SIZE, Image.Resampling.LANCZOS).save(stream, "PNG")
    return stream.getvalue()


def _draw_plot(
    picture: Image.Image, box: tuple[int, int, int, int], title: str, frames: Floats, shares: Floats
) -> None:
    left, top, right, bottom = box
    width, height = right - left, bottom - top
    highest = max(1.15, 1.05 * float(shares.max(initial=0.0)))
    first, last = float(frames[0]), float(frames[-1])
    pen = ImageDraw.Draw(picture)
    font = ImageFont.load_default(TYPE)
    for value in np.arange(0.0, highest, 0.25):
        y = bottom - value / highest * height
        pen.line((left, y, right, y), fill=GRID, width=FINER)
        pen.text((left - TYPE / 2, y), f"{value:g}", fill=INK, font=font, anchor="rm")
    for frame in np.linspace(first, last, 5):
        place = left + (frame - first) / max(last - first, 1.0) * width
        pen.text((place, bottom + TYPE / 2), f"{frame:.0f}", fill=INK, font=font, anchor="mt")
    x = (frames - first) / max(last - first, 1.0) * width
    mask = _overlap(x, height - shares / highest * height, (width, height))
    picture.paste(LINE, (left, top), mask)
    y = bottom - height / highest
    pen.line((left, y, right, y), fill=BOUND, width=3 * FINER // 2)
    pen.rectangle(box, outline=INK, width=FINER)
    pen.text((left, top - 0.7 * TYPE), title, fill=INK, font=font, anchor="lb")


def _overlap(x: Floats, y: Floats, size: tuple[int, int]) -> Image.Image:
    """Return the opacity of all curves y (t, p) over x (t,) together: more where many agree."""
    count = np.zeros((size[1], size[0]), np.float32)
    for column in y.T:
        layer = Image.new("L", size)
        points = list(zip(x.tolist(), column.tolist(), strict=True))
        ImageDraw.Draw(layer).line(points, fill=1, width=FINER)
        count += np.asarray(layer)
    return Image.fromarray((255 * (1 - (1 - OPACITY) ** count)).astype(np.uint8))
