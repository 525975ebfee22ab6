"""A child in a T-pose: arms stretched out, legs apart."""

from __future__ import annotations

from curves import blob, ellipse, leaf, polygon, ribbon, weld
from face import eye
from paint import INK, Canvas, Gradient, Mark
from shapely import box

_SKIN = Gradient(530 + 150j, 530 + 450j, "#ffd0a6", "#f5ad83")
_HAIR = Gradient(530 + 60j, 530 + 380j, "#8d4a34", "#5b2c2c")
_SWEATER = Gradient(530 + 430j, 530 + 740j, "#f2a541", "#e4572e")
_STRIPE = "#fff4dc"
_TROUSERS = Gradient(530 + 700j, 530 + 960j, "#3f8fb5", "#2f5f95")
_BOOT = "#a9542c"


def character() -> Canvas:
    """Draw the child."""
    canvas = Canvas(1060, 1100)
    for side in (-1, 1):
        canvas.form(ribbon([530 + side * 55 + 740j, 530 + side * 66 + 850j, 530 + side * 72 + 960j], [96, 80, 74]).shape, _TROUSERS)
        ankle = 530 + side * 72 + 970j
        boot = blob(ankle - 38 - 40j, ankle + 38 - 40j, ankle + (70 if side > 0 else 42) + 20j, ankle + 40 + 52j, ankle - 40 + 52j, ankle - (70 if side < 0 else 42) + 20j)
        canvas.form(boot, _BOOT)
        hand = weld(ellipse(530 + side * 430 + 520j, 46, 38), ribbon([530 + side * 415 + 505j, 530 + side * 425 + 462j], [28, 24]).shape, radius=6)
        canvas.form(hand, _SKIN)
    arms = ribbon([140 + 520j, 330 + 516j, 530 + 520j, 730 + 516j, 920 + 520j], [78, 84, 110, 84, 78])
    trunk = blob(440 + 480j, 530 + 470j, 620 + 480j, 640 + 620j, 645 + 760j, 530 + 780j, 415 + 760j, 420 + 620j)
    sweater = weld(arms.strip(0, 1, -1, 1), trunk, radius=30)
    stripes = [Mark(box(390, y, 670, y + 26), _STRIPE) for y in (600, 660)]
    canvas.form(sweater, _SWEATER, *stripes)
    back = ellipse(530 + 250j, 190, 200)
    canvas.form(back, _HAIR)
    head = blob(530 + 110j, 670 + 190j, 690 + 300j, 640 + 410j, 530 + 450j, 420 + 410j, 370 + 300j, 390 + 190j)
    canvas.form(head, _SKIN, *(Mark(ellipse(z, 32, 20), "#ff7f6b", 0.7, 7) for z in (425 + 350j, 635 + 350j)))
    eye(canvas, 460 + 290j, 32, "#3f6b3a")
    eye(canvas, 600 + 290j, 32, "#3f6b3a")
    canvas.line([485 + 375j, 530 + 400j, 575 + 375j], 8)
    return canvas
