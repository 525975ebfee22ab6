"""Three checkered bands: a bar, an S and a ring. Their squares show every stretch and turn."""

from __future__ import annotations

import numpy as np
from curves import Ribbon, ribbon, rounded, weld
from paint import Canvas, Mark, rgb

_CREAM = "#fff4dc"
_RAINBOW = ("#e4572e", "#f2a541", "#3fa796", "#3a7ca5", "#7d5ba6")


def _hue(share: float) -> str:
    """Colour of the rainbow at `share`, from 0 to 1."""
    stops = 255 * np.array([rgb(colour) for colour in _RAINBOW])
    place = np.linspace(0.0, 1.0, len(stops))
    red, green, blue = (round(np.interp(share, place, channel)) for channel in stops.T)
    return f"#{red:02x}{green:02x}{blue:02x}"


def _checkered(canvas: Canvas, band: Ribbon, columns: int, hues: list[float]) -> None:
    """Paint `band` with a checker of three rows and `columns` columns.

    Parameters
    ----------
    canvas : Canvas
    band : Ribbon
    columns : int
    hues : list of float
        Place in the rainbow, from 0 to 1, at even steps along the band.
    """
    marks = []
    for column in range(columns):
        start, end = column / columns, (column + 1) / columns
        hue = _hue(np.interp((start + end) / 2, np.linspace(0, 1, len(hues)), hues))
        # The outer rows reach out of the band, so that no cream shows between them and the ink.
        for left, right in ((-1.2, -1 / 3), (1 / 3, 1.2)) if column % 2 else ((-1 / 3, 1 / 3),):
            marks.append(Mark(band.strip(start, end, left, right), hue))
    halves = weld(band.strip(0.0, 0.5, -1.0, 1.0), band.strip(0.5, 1.0, -1.0, 1.0), radius=0.5)
    canvas.form(rounded(halves, 18), _CREAM, *marks, ink=7, gloss=0.5)


def bar() -> Canvas:
    """Draw a straight bar."""
    canvas = Canvas(1060, 260)
    _checkered(canvas, ribbon([60 + 130j, 1000 + 130j], 141), columns=20, hues=[0.0, 1.0])
    return canvas


def s() -> Canvas:
    """Draw a letter S."""
    canvas = Canvas(900, 1080)
    through = [
        700 + 250j,
        600 + 155j,
        450 + 130j,
        290 + 185j,
        230 + 320j,
        310 + 450j,
        450 + 525j,
        590 + 600j,
        670 + 730j,
        610 + 865j,
        450 + 920j,
        300 + 895j,
        200 + 800j,
    ]
    _checkered(canvas, ribbon(through, 150), columns=32, hues=[0.0, 1.0])
    return canvas


def ring() -> Canvas:
    """Draw a ring."""
    canvas = Canvas(1060, 1060)
    through = [530 + 530j - 375j * np.exp(2j * np.pi * k / 16) for k in range(16)]
    _checkered(canvas, ribbon(through, 180, closed=True), columns=36, hues=[0.0, 1.0, 0.0])
    return canvas
