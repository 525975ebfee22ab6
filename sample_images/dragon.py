"""A young dragon in profile, looking to the left, its long tail curled up behind it."""

from __future__ import annotations

import numpy as np
from curves import Ribbon, blob, ellipse, leaf, ribbon, rounded, weld
from face import eye
from paint import INK, Canvas, Gradient, Mark
from shapely.geometry.base import BaseGeometry

_SCALES = Gradient(300 + 100j, 560 + 720j, "#62cf9f", "#23908f")
_BELLY = "#ffe2a0"
_SPIKE = Gradient(400 + 100j, 700 + 600j, "#ffb057", "#ee6a3c")
_WING = Gradient(520 + 150j, 640 + 450j, "#ffb057", "#e4572e")
_CLAW = "#fff4dc"


def _spike(back: Ribbon, along: float, size: float) -> BaseGeometry:
    """A spike on the left edge of `back`, bent backwards."""
    foot, way = back.at(along, -0.85)[()], back.heading(along)[()]
    tip = foot + size * (-1j + 0.55) * way
    front, rear = foot - 0.62 * size * way, foot + 0.62 * size * way
    return rounded(
        leaf(
            [front, (front + tip) / 2 - 0.14j * size * way, tip],
            [tip, (rear + tip) / 2 + 0.10j * size * way, rear],
        ),
        2,
    )


def _leg(hip: complex, knee: complex, ankle: complex, thigh: float) -> BaseGeometry:
    leg = ribbon([hip, knee, ankle], [thigh, 70, 50]).shape
    foot = blob(
        ankle - 50 + 6j, ankle - 10 - 24j, ankle + 26 - 10j, ankle + 28 + 24j, ankle - 46 + 26j
    )
    return weld(leg, foot, radius=10)


def _claws(canvas: Canvas, ankle: complex) -> None:
    for k in (0, 1, 2):
        toe = ankle - 52 + 22 * k + 18j
        canvas.form(leaf([toe - 8 - 6j, toe - 14 + 9j], [toe - 14 + 9j, toe + 8 - 2j]), _CLAW, ink=4)


def dragon() -> Canvas:
    """Draw the dragon."""
    canvas = Canvas(1120, 900)
    back = ribbon(
        [232 + 250j, 262 + 360j, 360 + 470j, 500 + 505j, 630 + 525j, 760 + 600j, 890 + 610j,
         980 + 520j, 985 + 400j, 915 + 330j],
        [112, 128, 176, 208, 180, 112, 74, 52, 36, 20],
    )  # fmt: skip
    far = ((372 + 560j, 352 + 650j, 330 + 770j, 100), (640 + 580j, 700 + 660j, 660 + 770j, 120))
    near = ((440 + 560j, 452 + 670j, 440 + 790j, 110), (600 + 570j, 590 + 680j, 560 + 790j, 150))
    for leg in far:
        canvas.form(_leg(*leg), _SCALES, dim=0.55, gloss=0.0)
        _claws(canvas, leg[2])
    for along in np.linspace(0.05, 0.93, 16):
        canvas.form(_spike(back, along, np.interp(along, (0, 0.4, 1), (38, 50, 20))), _SPIKE)
    tip = back.at(1.0)[()]
    spade = leaf(
        [tip + 22 - 4j, tip + 10 - 44j, tip - 84 - 40j], [tip - 84 - 40j, tip - 40 + 30j, tip + 6 + 22j]
    )
    canvas.form(spade, _SPIKE)
    body = weld(back.shape, *(_leg(*leg) for leg in near), radius=12)
    plates = [Mark(back.strip(0.0, 0.95, 0.42, 1.4), _BELLY)]
    plates += [Mark(back.strip(a, a + 0.006, 0.42, 1.4), "#d99a5b") for a in np.arange(0.04, 0.9, 0.04)]
    hips = [Mark(_leg(*leg), _SCALES) for leg in near]
    canvas.form(body, _SCALES, *plates, *hips)
    for leg in near:
        _claws(canvas, leg[2])
    wing = leaf(
        [470 + 470j, 500 + 330j, 590 + 190j],
        [590 + 190j, 650 + 240j, 740 + 250j],
        [740 + 250j, 680 + 300j, 690 + 360j],
        [690 + 360j, 620 + 370j, 600 + 420j],
        [600 + 420j, 560 + 430j, 520 + 490j],
    )
    canvas.form(wing, _WING)
    for end in (740 + 250j, 690 + 360j, 600 + 420j):
        canvas.line([490 + 440j, (490 + 440j + end) / 2 - 20j, end], 5)
    canvas.form(ribbon([486 + 480j, 505 + 330j, 590 + 190j], [44, 30, 16]).shape, _SCALES)

    horn = ribbon([292 + 160j, 330 + 110j, 392 + 92j], [40, 26, 8]).shape
    canvas.form(horn, _CLAW)
    head = blob(
        220 + 120j, 290 + 140j, 318 + 210j, 290 + 290j, 220 + 318j, 140 + 318j, 76 + 296j,
        56 + 250j, 84 + 216j, 140 + 200j, 168 + 146j,
    )  # fmt: skip
    jaw = blob(60 + 290j, 140 + 296j, 230 + 300j, 220 + 340j, 120 + 340j)
    canvas.form(head, _SCALES, Mark(jaw, _BELLY, 1.0, 3), Mark(ellipse(262 + 262j, 24, 16), "#ff8f6b", 0.7, 6))
    canvas.flat(ellipse(90 + 240j, 7, 9, 30), INK)
    canvas.line([72 + 282j, 130 + 290j, 190 + 280j, 224 + 250j], 6)
    eye(canvas, 212 + 200j, 32, "#d97a1f", look=-8 + 2j)
    return canvas
