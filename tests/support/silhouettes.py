"""Silhouettes of people, animals and things, painted by strokes."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import shapely
from PIL import Image, ImageDraw

from engine.arrays import Complexes
from engine.geometry import as_xy

Stroke = tuple[Sequence[complex] | Complexes, float]


def drawn(*strokes: Stroke) -> list[Complexes]:
    """Return the outline and holes of what strokes (points, width) paint."""
    lines = [shapely.LineString(as_xy(np.asarray(points))) for points, _ in strokes]
    widths = [width for _, width in strokes]
    whole = shapely.union_all(shapely.buffer(lines, np.array(widths) / 2))
    loops = [whole.exterior, *whole.interiors]
    oriented = [np.array(loop.coords)[:-1] @ [1, 1j] for loop in loops]
    return [
        loop if shapely.LinearRing(as_xy(loop)).is_ccw == (number == 0) else loop[::-1]
        for number, loop in enumerate(oriented)
    ]


def dot(place: complex, radius: float) -> Stroke:
    return [place, place + 1], 2 * radius


def mirrored(*strokes: Stroke) -> list[Stroke]:
    """Each stroke, and what it is in a mirror at x = 0."""
    both = [(np.asarray(points), width) for points, width in strokes]
    return both + [(-points.conj(), width) for points, width in both]


CHILD = [
    dot(430j, 95),
    ([340j, 300j], 70),
    ([280j, 170j], 110),
    *mirrored(([20 + 290j, 140 + 280j, 225 + 285j], 40)),
    *mirrored(([35 + 160j, 45 + 30j], 56), ([45 + 25j, 75 + 20j], 44)),
]
WALKER = [
    dot(460j, 65),
    ([60 + 465j, 85 + 455j], 16),
    ([400j, 360j], 46),
    ([350j, -5 + 220j], 86),
    ([345j, 55 + 260j, 110 + 235j], 34),
    ([345j, -60 + 270j, -85 + 205j], 34),
    ([210j, 50 + 120j, 70 + 20j, 115 + 14j], 44),
    ([210j, -25 + 110j, -95 + 30j, -55 + 8j], 44),
]
KANGAROO = [
    ([-95 + 130j, -40 + 230j], 140),
    ([-50 + 220j, 30 + 350j, 55 + 420j], 76),
    ([50 + 450j, 110 + 440j, 140 + 430j], 46),
    ([45 + 480j, 30 + 540j], 24),
    ([20 + 330j, 80 + 300j, 100 + 250j], 28),
    ([-50 + 120j, -50 + 60j, -50 + 20j, 70 + 10j], 34),
    ([-130 + 90j, -210 + 40j, -290 + 12j], 44),
]
HORSE = [
    ([-140 + 280j, 80 + 285j], 130),
    ([95 + 300j, 150 + 390j, 175 + 460j], 64),
    ([175 + 470j, 245 + 405j], 48),
    ([-185 + 305j, -230 + 240j, -240 + 140j], 30),
    *[([x + 250j, x + 20j], 32) for x in (-185, -115, 55, 125)],
]
SNAKE = [(np.linspace(-240, 240, 40) + 40j * np.sin(np.linspace(0, 9, 40)), 44)]
FISH = [
    ([30, 100], 170),
    ([-140, -30], 60),
    *[(np.array([-150, -215 + 80j]), 26), (np.array([-150, -215 - 80j]), 26)],
]
GHOST = [([0, 200j], 240), *[([x, x - 120j], 70) for x in (-80, 0, 80)]]
TREE = [([0, 200j], 60), dot(320j, 140), dot(-90 + 270j, 90), dot(90 + 270j, 90)]
BODIES: Mapping[str, tuple[str, Sequence[Stroke]]] = {
    "child": ("biped-front", CHILD),
    "walker": ("biped-side", WALKER),
    "kangaroo": ("biped-side", KANGAROO),
    "horse": ("four-legs", HORSE),
    "snake": ("chain", SNAKE),
    "fish": ("chain", FISH),
    "ghost": ("anything", GHOST),
    "tree": ("anything", TREE),
}


def paint(folder: Path, name: str, *, size: int = 200) -> Path:
    """Return a picture of a body, so many pixels high."""
    loops = drawn(*BODIES[name][1])
    outline = loops[0]
    low = complex(outline.real.min(), outline.imag.min())
    scale = 0.9 * size / float(np.ptp(outline.imag))
    margin = 0.05 * size
    width = round(scale * float(np.ptp(outline.real)) + 2 * margin)
    picture = Image.new("RGBA", (width, size))
    pen = ImageDraw.Draw(picture)
    for loop, colour in zip(loops, ["#c06040", *["#0000"] * (len(loops) - 1)], strict=True):
        places = scale * (loop - low)
        corners = [(x + margin, size - margin - y) for x, y in as_xy(places).tolist()]
        pen.polygon(corners, fill=colour)
    path = folder / f"{name}.png"
    picture.save(path)
    return path
