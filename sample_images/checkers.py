"""Three checkered bands: a bar, an S and a ring. Their squares show every stretch and turn."""

from __future__ import annotations

import numpy as np
from curves import Ribbon, ribbon, rounded
from paint import Canvas, Mark
from shapely import union_all

_CREAM = "#fff4dc"
_RAINBOW = ("#e4572e", "#f2a541", "#3fa796", "#3a7ca5", "#7d5ba6")


def _hue(share: float) -> str:
    """Colour of the rainbow at `share`, from 0 to 1."""
    stops = np.array([[int(c[i : i + 2], 16) for i in (1, 3, 5)] for c in _RAINBOW])
    place = np.linspace(0.0, 1.0, len(stops))
    red, green, blue = (round(np.interp(share, place, channel)) for channel in stops.T)
    return f"#{red:02x}{green:02x}{blue:02x}"


def _checkered(canvas: Canvas, band: Ribbon, columns: int, rows: int, corner: float) -> None:
    """Paint `band` with a checker of `columns` squares along it and `rows` across."""
    marks = []
    for column in range(columns):
        start, end = column / columns, (column + 1) / columns
        for row in range(column % 2, rows, 2):
            left, right = 2 * row / rows - 1, 2 * (row + 1) / rows - 1
            square = band.strip(start, end, left, right)
            # A closed band comes back to its first colour.
            share = 1 - abs(2 * start - 1) if corner == 0 else start
            marks.append(Mark(square, _hue(share)))
    quarter = 0.25
    parts = [band.strip(q * quarter, (q + 1) * quarter, -1.0, 1.0) for q in range(4)]
    shape = rounded(union_all([part.buffer(0.5) for part in parts]), corner)
    canvas.form(shape, _CREAM, *marks, ink=7, gloss=0.5)


def bar() -> Canvas:
    """Draw a straight bar."""
    canvas = Canvas(1060, 260)
    _checkered(canvas, ribbon([60 + 130j, 1000 + 130j], 141), columns=20, rows=3, corner=18)
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
    _checkered(canvas, ribbon(through, 150), columns=32, rows=3, corner=18)
    return canvas


def ring() -> Canvas:
    """Draw a ring."""
    canvas = Canvas(1060, 1060)
    through = [530 + 530j - 375j * np.exp(2j * np.pi * k / 16) for k in range(16)]
    _checkered(canvas, ribbon(through, 180, closed=True), columns=36, rows=3, corner=0)
    return canvas
