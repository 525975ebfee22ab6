"""An octopus, seen from the front, with eight arms well apart."""

from __future__ import annotations

from curves import blob, ellipse, ribbon, weld
from face import eye
from paint import Canvas, Gradient, Mark
from shapely import union_all

_SKIN = Gradient(520 + 60j, 540 + 980j, "#ff8a7a", "#c2478f")
_UNDERSIDE = "#ffd3c4"
_SUCKER = "#e58aa0"
_SPOT = "#d94f7a"

# The arms on the left, from the highest to the lowest, each from the head to its tip; those on the
# right mirror them about x = 530, a little displaced, so that they do not look stamped.
_ARMS = (
    (430 + 520j, 320 + 560j, 205 + 520j, 140 + 420j, 160 + 320j, 235 + 300j),
    (430 + 560j, 310 + 640j, 190 + 650j, 95 + 600j, 55 + 520j),
    (450 + 590j, 370 + 710j, 265 + 790j, 150 + 790j, 90 + 725j),
    (490 + 610j, 470 + 750j, 420 + 870j, 330 + 930j, 235 + 905j),
)
_WIDTHS = (104, 74, 54, 38, 24)


def octopus() -> Canvas:
    """Draw the octopus."""
    canvas = Canvas(1060, 1060)
    arms = []
    for number, points in enumerate(_ARMS):
        widths = (104, 78, 62, 48, 34, 20)[:2] + (104, 78, 62, 48, 34, 20)[2 - len(points) :]
        arms.append((ribbon(points, widths[: len(points)]), 1))
        other = [1060 - z.conjugate() + (6 - 4 * number) * (1 + 1j) for z in points]
        arms.append((ribbon(other, widths[: len(points)]), -1))
    skirt = ellipse(530 + 545j, 150, 95)
    body = weld(skirt, *(arm.shape for arm, _ in arms), radius=16)
    marks = []
    for arm, side in arms:
        low, high = sorted((0.15 * side, 1.3 * side))
        under = union_all([arm.strip(0.25, 0.97, low, high)])
        marks.append(Mark(under, _UNDERSIDE, 1.0, 1.5))
        for k in range(9):
            along = 0.33 + 0.07 * k
            place = arm.at(along, 0.58 * side)[()]
            size = abs(arm.at(along, 1.0)[()] - arm.at(along)[()])
            marks.append(Mark(ellipse(place, 0.27 * size), _SUCKER))
            marks.append(Mark(ellipse(place - 1 - 1j, 0.13 * size), "#b94f7d"))
    canvas.form(body, _SKIN, *marks)
    head = blob(
        530 + 70j, 680 + 110j, 760 + 250j, 730 + 400j, 690 + 500j, 650 + 580j, 530 + 620j,
        410 + 580j, 370 + 500j, 330 + 400j, 300 + 250j, 380 + 110j,
    )  # fmt: skip
    spots = [
        Mark(ellipse(z, r, 0.8 * r, -20), _SPOT, 0.7, 1)
        for z, r in ((440 + 140j, 26), (500 + 110j, 14), (640 + 150j, 18), (690 + 220j, 28),
                     (390 + 215j, 16), (715 + 300j, 12))
    ]  # fmt: skip
    cheeks = [Mark(ellipse(z, 34, 22), "#ff5f7e", 0.8, 8) for z in (400 + 470j, 660 + 470j)]
    canvas.form(head, _SKIN, *spots, *cheeks)
    eye(canvas, 450 + 390j, 46, "#3a7ca5", look=6 + 4j)
    eye(canvas, 610 + 390j, 46, "#3a7ca5", look=-6 + 4j)
    canvas.line([480 + 488j, 505 + 512j, 530 + 518j, 555 + 512j, 580 + 488j], 8)
    return canvas
