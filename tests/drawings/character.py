"""A child in a T-pose: arms stretched out, legs apart."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from curves import blob, ellipse, leaf, mirrored, polygon, ribbon, rounded, weld
from face import eye
from paint import Canvas, Gradient, Mark
from shapely.geometry.base import BaseGeometry

_AXIS = 530
SKIN = Gradient(530 + 150j, 530 + 600j, "#ffd6b0", "#f6b48c")
_HAIR = Gradient(480 + 60j, 560 + 360j, "#a5583a", "#6b3230")
WOOL = Gradient(530 + 480j, 530 + 720j, "#f7ad45", "#ee7a3a")
CREAM = "#fff4dc"
_DENIM = Gradient(530 + 580j, 530 + 960j, "#4fa3c4", "#2f659c")
_TURN_UP = "#a9d8e6"
_SEAM = "#234a7d"
_BOOT = Gradient(530 + 930j, 530 + 1050j, "#c9743a", "#8f4526")
_BRASS = "#ffd25e"


Side = Callable[[Sequence[complex]], list[complex]]
# The left of the picture is drawn, the right is its mirror image.
SIDES = (list[complex], partial(mirrored, axis=_AXIS))


def _both(*points: complex) -> list[list[complex]]:
    return [side(points) for side in SIDES]


def hands(canvas: Canvas, sides: Sequence[Side] = SIDES) -> None:
    """Draw both hands, or one."""
    palm = (172 + 516j, 124 + 502j, 72 + 512j, 46 + 544j, 70 + 580j, 124 + 588j, 172 + 572j)
    thumb = (136 + 530j, 118 + 496j, 112 + 466j)
    fingers = ((52 + 532j, 74 + 534j, 96 + 532j), (52 + 556j, 74 + 557j, 96 + 554j))
    for side in sides:
        canvas.form(
            weld(blob(*side(palm)), ribbon(side(thumb), [40, 34, 28]).shape, radius=8), SKIN
        )
        for finger in fingers:
            canvas.line(side(finger), 5)


def boots(canvas: Canvas) -> None:
    """Draw both boots."""
    shaft = (414 + 900j, 500 + 900j, 504 + 980j, 510 + 1028j)
    front = (376 + 1028j, 374 + 988j, 408 + 964j, 414 + 900j)
    sole = (300 + 1012j, 600 + 1012j, 600 + 1100j, 300 + 1100j)
    gleam = (400 + 984j, 430 + 974j, 462 + 978j)
    for side in SIDES:
        boot = rounded(leaf(side(shaft), side(front)), 12)
        canvas.form(boot, _BOOT, Mark(polygon(side(sole)), "#5b2c2c"))
        canvas.line(side(gleam), 6, CREAM)


def _sweater(canvas: Canvas) -> None:
    sleeves = ribbon(
        [168 + 544j, 330 + 538j, 530 + 545j, 730 + 538j, 892 + 544j], [70, 84, 118, 84, 70]
    )
    trunk = blob(
        440 + 492j, 530 + 476j, 620 + 492j, 640 + 620j,
        646 + 740j, 530 + 770j, 414 + 740j, 420 + 620j,
    )  # fmt: skip
    marks = [
        Mark(sleeves.strip(a, a + 0.04, -1.2, 1.2), CREAM)
        for a in (0.06, 0.145, 0.23, 0.73, 0.815, 0.9)
    ]
    canvas.form(weld(sleeves.strip(0, 1, -1, 1), trunk, radius=26), WOOL, *marks)
    for points in _both(168 + 512j, 164 + 544j, 168 + 576j):
        canvas.form(ribbon(points, 26).shape, CREAM)


def dungarees(canvas: Canvas) -> None:
    """Draw the dungarees with their straps."""
    legs = [
        ribbon(points, [124, 98, 86]).strip(0, 1, -1, 1)
        for points in _both(480 + 720j, 464 + 830j, 457 + 926j)
    ]
    hips = blob(428 + 690j, 530 + 670j, 632 + 690j, 642 + 760j, 530 + 800j, 418 + 760j)
    bib = rounded(polygon([452 + 588j, 608 + 588j, 622 + 700j, 438 + 700j]), 14)
    canvas.form(weld(weld(hips, bib, radius=60), *legs, radius=10), _DENIM)
    for points in _both(410 + 924j, 457 + 930j, 502 + 924j):
        canvas.form(ribbon(points, 34).strip(0, 1, -1, 1).buffer(3), _TURN_UP)
    for points in _both(470 + 606j, 454 + 545j, 462 + 486j):
        canvas.form(ribbon(points, 30).shape, _DENIM, ink=5)
    for [button] in _both(470 + 612j):
        canvas.form(ellipse(button, 13), _BRASS, ink=4)
    pocket = rounded(polygon([486 + 640j, 574 + 640j, 570 + 700j, 530 + 716j, 490 + 700j]), 8)
    canvas.form(pocket, _DENIM, ink=4, gloss=0)
    canvas.line([490 + 660j, 530 + 661j, 570 + 660j], 4, _SEAM)
    for points in _both(432 + 734j, 452 + 764j, 490 + 770j):
        canvas.line(points, 5, _SEAM)


def _fringe() -> BaseGeometry:
    """The hair over the forehead, down to the temples: locks that end in points."""
    locks = (
        [330 + 376j, 318 + 340j, 320 + 240j, 362 + 140j, 430 + 88j, 508 + 72j],
        [508 + 72j, 500 + 46j, 516 + 30j, 552 + 28j], [552 + 28j, 536 + 44j, 542 + 58j, 572 + 72j],
        [572 + 72j, 640 + 90j, 700 + 142j, 740 + 240j, 742 + 340j, 730 + 376j],
        [730 + 376j, 700 + 340j, 688 + 248j], [688 + 248j, 674 + 266j, 648 + 276j],
        [648 + 276j, 650 + 240j, 628 + 196j], [628 + 196j, 610 + 242j, 564 + 270j],
        [564 + 270j, 562 + 230j, 528 + 190j], [528 + 190j, 502 + 244j, 446 + 274j],
        [446 + 274j, 444 + 250j, 418 + 218j], [418 + 218j, 396 + 300j, 330 + 376j],
    )  # fmt: skip
    return rounded(leaf(*locks), 2)


def head(canvas: Canvas) -> None:
    """Draw the head with everything on it but the mouth."""
    back = blob(
        530 + 90j, 690 + 140j, 722 + 290j, 690 + 420j,
        530 + 440j, 370 + 420j, 338 + 290j, 370 + 140j,
    )  # fmt: skip
    canvas.form(back, _HAIR, dim=0.5, gloss=0)
    canvas.form(
        ribbon([530 + 420j, 530 + 492j], [100, 124]).strip(0, 1, -1, 1), SKIN, dim=0.5, gloss=0
    )
    canvas.form(ribbon([468 + 486j, 530 + 506j, 592 + 486j], 30).shape, CREAM)
    for [ear] in _both(366 + 338j):
        shell = Mark(ellipse(ear, 17, 22), "#f08f78", 0.8, 2)
        canvas.form(ellipse(ear, 32, 38), SKIN, shell)
    face = blob(
        530 + 120j, 660 + 176j, 694 + 300j, 660 + 404j, 590 + 456j, 530 + 466j,
        470 + 456j, 400 + 404j, 366 + 300j, 400 + 176j,
    )  # fmt: skip
    cheeks = [Mark(ellipse(cheek, 36, 22), "#ff7f6b", 0.7, 8) for [cheek] in _both(424 + 386j)]
    shade = Mark(_fringe().buffer(12), "#d98a6f", 0.6, 4)
    canvas.form(face, SKIN, *cheeks, shade, gloss=0)
    canvas.form(_fringe(), _HAIR)
    for strand in (
        [418 + 214j, 422 + 172j, 452 + 132j], [528 + 186j, 518 + 142j, 526 + 102j],
        [628 + 192j, 618 + 154j, 594 + 122j], [688 + 244j, 682 + 206j, 660 + 174j],
    ):  # fmt: skip
        canvas.line(strand, 5)
    eye(canvas, 462 + 348j, 36, "#3f7d4a", look=3 + 2j)
    eye(canvas, 598 + 348j, 36, "#3f7d4a", look=-3 + 2j)
    canvas.line([518 + 386j, 530 + 394j, 542 + 386j], 6, "#b5604a")


def mouth(canvas: Canvas) -> None:
    """Draw the laughing mouth."""
    lips = leaf(
        [484 + 408j, 530 + 416j, 576 + 408j],
        [576 + 408j, 560 + 440j, 530 + 450j, 500 + 440j, 484 + 408j],
    )
    teeth = Mark(ellipse(530 + 404j, 40, 19), CREAM)
    tongue = Mark(ellipse(530 + 452j, 26, 16), "#ff7d7e")
    canvas.form(lips, "#8a2540", teeth, tongue, ink=4, gloss=0)


def character() -> Canvas:
    """Draw the child."""
    canvas = Canvas(1060, 1100)
    hands(canvas)
    boots(canvas)
    _sweater(canvas)
    dungarees(canvas)
    head(canvas)
    mouth(canvas)
    return canvas
