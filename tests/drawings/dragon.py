"""A young dragon in profile, looking to the left, its long tail curled up behind it."""

from __future__ import annotations

import numpy as np
from curves import Ribbon, blob, ellipse, leaf, ribbon, rounded, weld
from face import eye
from paint import INK, Canvas, Gradient, Mark
from shapely.geometry.base import BaseGeometry

_SCALES = Gradient(300 + 100j, 560 + 720j, "#6ad8a4", "#23908f")
_DARK_SCALE = "#1d8482"
_BELLY = "#ffe6ae"
_SEAM = "#d99a5b"
_FLAME = Gradient(560 + 180j, 660 + 600j, "#ffb959", "#e9603a")
_IVORY = "#fff4dc"

# Hip, knee, heel, ankle; thickness at the hip. The front legs first.
_FAR_LEGS = (
    ((380 + 560j, 362 + 640j, 338 + 720j, 322 + 780j), 104),
    ((712 + 572j, 730 + 650j, 766 + 716j, 746 + 780j), 96),
)
_NEAR_LEGS = (
    ((456 + 550j, 468 + 640j, 464 + 730j, 446 + 800j), 112),
    ((646 + 556j, 616 + 646j, 644 + 730j, 612 + 800j), 160),
)


def _spike(back: Ribbon, along: float, size: float) -> BaseGeometry:
    """A spike on the left edge of `back`, bent backwards."""
    foot, way = complex(back.at(along, -0.82)), complex(back.heading(along))
    tip = foot + size * (0.5 - 1.3j) * way
    front, rear = foot - 0.6 * size * way, foot + 0.6 * size * way
    return rounded(
        leaf(
            [front, (front + tip) / 2 - 0.15j * size * way, tip],
            [tip, (rear + tip) / 2 + 0.12 * size * way * (-1 + 0.4j), rear],
        ),
        2,
    )


def _leg(joints: tuple[complex, ...], thigh: float) -> BaseGeometry:
    ankle = joints[-1]
    foot = blob(
        ankle - 44 + 8j, ankle - 12 - 22j, ankle + 24 - 14j, ankle + 30 + 24j, ankle - 40 + 26j
    )
    return weld(ribbon(joints, [thigh, 80, 54, 50]).shape, foot, radius=10)


def _claws(canvas: Canvas, ankle: complex) -> None:
    for toe in (ankle - 42 + 14j, ankle - 20 + 20j, ankle + 2 + 21j):
        claw = leaf(
            [toe + 8 - 8j, toe - 8 - 8j, toe - 13 + 9j], [toe - 13 + 9j, toe + 3 + 9j, toe + 8 - 8j]
        )
        canvas.form(claw, _IVORY, ink=4)


def _wing(canvas: Canvas) -> None:
    """A small wing: skin between the fingers, which spring from the wrist."""
    shoulder, wrist, root = 490 + 480j, 560 + 216j, 580 + 462j
    tips = (764 + 236j, 748 + 344j, 668 + 424j)
    skin = leaf(
        [shoulder, 490 + 424j, 514 + 320j, wrist],
        [wrist, 664 + 196j, tips[0]],
        [tips[0], 730 + 290j, tips[1]],
        [tips[1], 690 + 374j, tips[2]],
        [tips[2], 606 + 436j, root],
        [root, 534 + 452j, shoulder],
    )
    canvas.form(rounded(skin, 2), _FLAME)
    for tip, bend in zip((*tips[1:], root), (664 + 262j, 622 + 300j, 566 + 330j), strict=True):
        canvas.line([wrist, bend, tip], 6)
    canvas.form(
        ribbon([shoulder + 6j, 486 + 424j, 510 + 320j, wrist], [10, 38, 30, 18]).shape,
        _SCALES,
        ink=5,
    )
    claw = leaf(
        [wrist - 9 + 4j, wrist - 12 - 16j, wrist - 26 - 36j],
        [wrist - 26 - 36j, wrist + 4 - 24j, wrist + 9 + 2j],
    )
    canvas.form(claw, _IVORY, ink=5)


def _head(canvas: Canvas) -> None:
    canvas.form(ribbon([258 + 150j, 270 + 92j, 316 + 54j], [34, 24, 7]).shape, _IVORY, dim=0.5)
    canvas.form(ribbon([296 + 166j, 330 + 112j, 396 + 92j], [42, 28, 8]).shape, _IVORY)
    fin = leaf(
        [290 + 212j, 350 + 178j, 414 + 186j],
        [414 + 186j, 384 + 206j, 398 + 236j],
        [398 + 236j, 364 + 240j, 366 + 274j],
        [366 + 274j, 320 + 276j, 284 + 262j],
    )
    canvas.form(rounded(fin, 2), _FLAME)
    for end in (392 + 194j, 380 + 232j):
        canvas.line([306 + 232j, (320 + 232j + end) / 2, end], 4)
    skull = blob(
        224 + 112j, 292 + 134j, 322 + 206j, 296 + 288j, 226 + 322j, 140 + 326j, 72 + 304j,
        50 + 256j, 76 + 212j, 112 + 212j, 146 + 200j, 168 + 142j,
    )  # fmt: skip
    jaw = blob(40 + 286j, 130 + 302j, 226 + 298j, 240 + 350j, 120 + 350j)
    marks = [
        Mark(jaw, _BELLY, 1.0, 2),
        Mark(ellipse(268 + 262j, 27, 18), "#ff8f6b", 0.75, 6),
        *(
            Mark(ellipse(z, r), _DARK_SCALE, 0.5)
            for z, r in ((282 + 172j, 10), (300 + 200j, 7), (262 + 146j, 7))
        ),
    ]
    canvas.form(skull, _SCALES, *marks)
    canvas.flat(ellipse(88 + 240j, 7, 10, 35), INK)
    canvas.line([66 + 288j, 126 + 302j, 190 + 292j, 232 + 254j], 7)
    tooth = leaf([96 + 297j, 104 + 318j], [104 + 318j, 116 + 300j])
    canvas.form(tooth, _IVORY, ink=3, gloss=0)
    eye(canvas, 208 + 200j, 36, "#d9771a", look=-9 + 3j)
    canvas.line([184 + 144j, 214 + 132j, 250 + 150j], 8)


def _far_legs(canvas: Canvas) -> None:
    for joints, thigh in _FAR_LEGS:
        canvas.form(_leg(joints, thigh), _SCALES, dim=0.6, gloss=0)
        _claws(canvas, joints[-1])


def _tail_tip(canvas: Canvas, back: Ribbon) -> None:
    end, way = complex(back.at(1.0)), complex(back.heading(1.0))
    sides = [[end + way * z for z in side] for side in ((-14, 4 + 44j, 92), (92, 4 - 44j, -14))]
    canvas.form(rounded(leaf(*sides), 3), _FLAME)


def _body(canvas: Canvas) -> None:
    """Neck, trunk, tail and near legs in one piece, with the spikes behind it."""
    back = ribbon(
        [236 + 250j, 266 + 370j, 362 + 474j, 500 + 505j, 640 + 520j, 770 + 590j, 890 + 610j,
         982 + 530j, 985 + 410j, 915 + 340j],
        [112, 130, 176, 208, 184, 116, 78, 54, 36, 22],
    )  # fmt: skip
    for along in np.linspace(0.035, 0.93, 15):
        canvas.form(_spike(back, along, np.interp(along, (0, 0.4, 1), (40, 52, 22))), _FLAME)
    legs = [_leg(joints, thigh) for joints, thigh in _NEAR_LEGS]
    plates = [Mark(back.strip(0.0, 0.97, 0.42, 1.4), _BELLY)]
    plates += [
        Mark(back.strip(a, a + 0.005, 0.42, 1.4), _SEAM) for a in np.arange(0.04, 0.95, 0.035)
    ]
    hips = [Mark(leg, _SCALES) for leg in legs]
    dots = [
        Mark(ellipse(complex(back.at(along, side)), size, 0.75 * size, 30), _DARK_SCALE, 0.45)
        for along, side, size in (
            (0.14, -0.3, 7), (0.2, -0.1, 11), (0.23, -0.45, 8), (0.46, -0.4, 13), (0.5, -0.05, 9),
            (0.54, -0.45, 8), (0.6, -0.2, 11), (0.65, -0.5, 6), (0.72, -0.1, 7),
        )
    ]  # fmt: skip
    canvas.form(weld(back.shape, *legs, radius=12), _SCALES, *plates, *hips, *dots)
    for crease in (
        (410 + 520j, 399 + 556j, 404 + 604j), (508 + 524j, 513 + 556j, 509 + 592j),
        (573 + 606j, 566 + 558j, 594 + 504j, 656 + 478j),
    ):  # fmt: skip
        canvas.line(crease, 6)
    _tail_tip(canvas, back)
    for joints, _ in _NEAR_LEGS:
        _claws(canvas, joints[-1])


def dragon() -> Canvas:
    """Draw the dragon."""
    canvas = Canvas(1120, 900)
    _far_legs(canvas)
    _body(canvas)
    _wing(canvas)
    _head(canvas)
    return canvas
