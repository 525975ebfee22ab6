"""An octopus, seen from the front, with eight arms well apart."""

from __future__ import annotations

import numpy as np
from curves import Ribbon, blob, ellipse, ribbon, weld
from face import eye
from paint import Canvas, Gradient, Mark

_SKIN = Gradient(520 + 60j, 540 + 980j, "#ff9078", "#c4458f")
_UNDERSIDE = Gradient(520 + 300j, 540 + 980j, "#ffe0c8", "#ffc2cf")
_RIM, _CUP = "#e9809a", "#a93f78"
_SPOT = "#dd5578"

# From the head to the tip; those on the left from the highest to the lowest, then the right.
_LEFT = (
    (440 + 520j, 320 + 560j, 205 + 520j, 150 + 420j, 168 + 320j, 130 + 240j, 66 + 232j, 62 + 280j),
    (440 + 560j, 320 + 645j, 200 + 680j, 95 + 642j, 48 + 570j, 88 + 514j),
    (460 + 590j, 385 + 720j, 280 + 800j, 165 + 822j, 78 + 786j, 86 + 736j),
    (500 + 610j, 485 + 760j, 440 + 890j, 350 + 965j, 250 + 975j, 190 + 930j, 210 + 892j),
)
_RIGHT = (
    (620 + 520j, 730 + 550j, 845 + 505j, 900 + 400j, 885 + 290j, 915 + 200j, 978 + 165j,
     1008 + 210j),
    (620 + 560j, 745 + 640j, 870 + 668j, 965 + 625j, 1002 + 548j, 962 + 502j),
    (600 + 590j, 670 + 720j, 775 + 800j, 890 + 820j, 985 + 785j, 1016 + 722j, 982 + 692j),
    (560 + 610j, 575 + 760j, 620 + 890j, 710 + 965j, 815 + 968j, 872 + 925j, 848 + 888j),
)  # fmt: skip


def _arm(points: tuple[complex, ...]) -> Ribbon:
    share = np.linspace(0.0, 1.0, len(points))
    return ribbon(points, np.interp(share, (0.0, 0.25, 1.0), (112, 74, 15)))


def _underside(arm: Ribbon, side: float) -> list[Mark]:
    """The pale side of an arm with its suckers, smaller towards the tip."""
    along = np.linspace(0.12, 1.0, 30)
    # The pale band begins as a point between the arms and then fills its half of the arm.
    width = np.abs(arm.at(along, 1.0) - arm.at(along)) * np.clip((along - 0.1) / 0.25, 0.0, 1.0)
    marks = [Mark(ribbon(arm.at(along, 0.6 * side), width).shape, _UNDERSIDE, blur=1)]
    place = 0.19
    while place < 0.94:
        size = float(np.interp(place, along, width))
        centre = complex(arm.at(place, 0.55 * side))
        marks += [Mark(ellipse(centre, 0.4 * size), _RIM), Mark(ellipse(centre, 0.2 * size), _CUP)]
        place += 0.014 + 0.0018 * size
    return marks


def octopus() -> Canvas:
    """Draw the octopus."""
    canvas = Canvas(1100, 1060)
    mantle = blob(
        530 + 62j, 668 + 96j, 762 + 210j, 770 + 340j, 706 + 446j, 668 + 540j, 530 + 640j,
        392 + 540j, 354 + 446j, 290 + 340j, 298 + 210j, 392 + 96j,
    )  # fmt: skip
    left, right = [_arm(points) for points in _LEFT], [_arm(points) for points in _RIGHT]
    marks = [mark for arm in left for mark in _underside(arm, 1.0)]
    marks += [mark for arm in right for mark in _underside(arm, -1.0)]
    marks += [
        Mark(ellipse(centre, size, 0.8 * size, -20), _SPOT, 0.65, 1)
        for centre, size in (
            (428 + 160j, 30), (496 + 118j, 16), (372 + 236j, 16), (628 + 142j, 20),
            (690 + 214j, 32), (724 + 300j, 14),
        )
    ]  # fmt: skip
    marks += [Mark(ellipse(z, 38, 24), "#ff4f78", 0.75, 9) for z in (392 + 500j, 668 + 500j)]
    canvas.form(weld(mantle, *(arm.shape for arm in left + right), radius=16), _SKIN, *marks)

    eye(canvas, 448 + 416j, 54, "#2f86a8", look=8 + 6j)
    eye(canvas, 612 + 416j, 54, "#2f86a8", look=-8 + 6j)
    canvas.line([404 + 322j, 436 + 304j, 474 + 314j], 9)
    canvas.line([586 + 314j, 624 + 304j, 656 + 322j], 9)
    mouth = blob(486 + 520j, 530 + 528j, 574 + 520j, 560 + 556j, 530 + 568j, 500 + 556j)
    canvas.form(mouth, "#8a2550", Mark(ellipse(530 + 568j, 30, 20), "#ff7d8e"), ink=5, gloss=0)
    return canvas
