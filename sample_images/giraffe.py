"""A giraffe in profile, looking to the left."""

from __future__ import annotations

import numpy as np
import shapely
from curves import blob, ellipse, leaf, ribbon, rounded, weld
from face import eye
from paint import INK, Canvas, Gradient, Mark
from shapely.geometry.base import BaseGeometry

_HIDE = Gradient(400 + 100j, 520 + 760j, "#ffd37a", "#f9bb5c")
_PATCH = Gradient(300 + 150j, 560 + 720j, "#c9743a", "#a9542c")
_CREAM = "#fff0d0"
_MANE = "#8f4526"
_HOOF = "#6b4136"


def _patches(where: BaseGeometry) -> list[Mark]:
    """Rounded Voronoi cells of seeds that lie closer together towards the head."""
    rng = np.random.default_rng(5)
    left, top, right, bottom = where.bounds
    seeds: list[complex] = []
    for x, y in rng.uniform((left, top), (right, bottom), (6000, 2)):
        spacing = np.interp(y, (150, 520), (50, 84))
        if all(abs(x + 1j * y - seed) > spacing for seed in seeds):
            seeds.append(complex(x, y))
    cells = shapely.voronoi_polygons(shapely.MultiPoint([(z.real, z.imag) for z in seeds]))
    rims = [rounded(cell.buffer(-5), 13) for cell in cells.geoms]
    return [Mark(rim.intersection(where), _PATCH) for rim in rims if rim.intersects(where)]


def _leg(hip: complex, knee: complex, ankle: complex, *, thigh: float) -> BaseGeometry:
    calf = (knee + ankle) / 2
    return ribbon([hip, (hip + knee) / 2, knee, calf, ankle], [thigh, 62, 46, 36, 40]).shape


def _hoof(ankle: complex) -> BaseGeometry:
    return leaf(
        [ankle - 19 - 14j, ankle - 26 + 18j],
        [ankle - 26 + 18j, ankle + 26 + 18j],
        [ankle + 26 + 18j, ankle + 19 - 14j],
    )


def giraffe() -> Canvas:
    """Draw the giraffe."""
    canvas = Canvas(840, 1080)
    legs = {
        "far front": (372 + 640j, 322 + 800j, 312 + 985j),
        "far hind": (610 + 640j, 556 + 800j, 548 + 985j),
        "near front": (420 + 650j, 412 + 810j, 404 + 1000j),
        "near hind": (632 + 620j, 652 + 810j, 640 + 1000j),
    }
    tail = ribbon([665 + 560j, 712 + 610j, 730 + 690j, 724 + 760j], [26, 18, 15, 14])
    canvas.form(tail.shape, _HIDE)
    tuft = leaf([718 + 745j, 700 + 800j, 722 + 862j], [722 + 862j, 752 + 805j, 734 + 745j])
    canvas.form(tuft, _MANE)

    for name in ("far front", "far hind"):
        hip, knee, ankle = legs[name]
        canvas.form(_leg(hip, knee, ankle, thigh=96), _HIDE, dim=0.55, gloss=0.0)
        canvas.form(_hoof(ankle), _HOOF, dim=0.5, gloss=0.0)

    neck = ribbon(
        [430 + 600j, 372 + 480j, 325 + 350j, 292 + 235j, 272 + 160j], [210, 150, 104, 80, 76]
    )
    mane = ribbon([neck.at(a, 1.0)[()] for a in (0.2, 0.4, 0.6, 0.8, 1.0)], [12, 34, 38, 36, 24])
    canvas.form(mane.shape, _MANE)

    trunk = blob(
        330 + 560j, 380 + 490j, 480 + 490j, 600 + 520j, 680 + 580j, 690 + 650j, 620 + 715j,
        500 + 728j, 390 + 720j, 338 + 650j,
    )  # fmt: skip
    near = [_leg(*legs[name], thigh=120) for name in ("near front", "near hind")]
    body = weld(trunk, neck.shape, *near, radius=14)
    coat = body.intersection(shapely.box(0, 140, 840, 800))
    belly = blob(330 + 735j, 430 + 700j, 560 + 700j, 640 + 735j, 500 + 780j)
    canvas.form(body, _HIDE, *_patches(coat), Mark(belly, _CREAM, 0.8, 6))
    for name in ("near front", "near hind"):
        canvas.form(_hoof(legs[name][2]), _HOOF)

    for foot, tip in ((292 + 100j, 300 + 42j), (250 + 100j, 246 + 38j)):
        canvas.form(ribbon([foot, tip], [24, 18]).shape, _HIDE)
        canvas.form(ellipse(tip, 17, 15), _MANE)
    ear = leaf([310 + 132j, 360 + 90j, 408 + 92j], [408 + 92j, 388 + 142j, 318 + 160j])
    canvas.form(ear, _HIDE, Mark(ear.buffer(-9), "#f5a07c"))

    head = blob(
        250 + 88j, 306 + 100j, 330 + 160j, 300 + 222j, 240 + 240j, 190 + 262j, 138 + 258j,
        112 + 222j, 136 + 184j, 186 + 150j, 212 + 106j,
    )  # fmt: skip
    muzzle = ellipse(150 + 225j, 62, 46, -18)
    cheek = ellipse(252 + 200j, 22, 15)
    canvas.form(head, _HIDE, Mark(muzzle, _CREAM, 1.0, 5), Mark(cheek, "#f58f6c", 0.6, 6))
    canvas.flat(ellipse(132 + 205j, 6, 8, 30), INK)
    canvas.line([128 + 240j, 160 + 246j, 192 + 236j, 208 + 218j], 5)
    eye(canvas, 240 + 150j, 23, "#5b3420", look=-6 + 1j)
    return canvas
