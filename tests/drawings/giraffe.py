"""A giraffe in profile, looking to the left."""

from __future__ import annotations

import numpy as np
import shapely
from curves import Ribbon, blob, ellipse, leaf, ribbon, rounded, weld
from face import eye
from paint import INK, Canvas, Gradient, Mark
from shapely.geometry.base import BaseGeometry

_HIDE = Gradient(400 + 520j, 440 + 860j, "#ffd27a", "#ffe2a8")
_PATCH = Gradient(300 + 150j, 560 + 720j, "#d8853f", "#bb612f")
_CREAM = "#fff3d9"
_MANE = "#8f4526"
_HOOF = "#6b4136"

# Hip, knee and ankle, the front legs first.
_FAR_LEGS = (
    (392 + 630j, 338 + 790j, 326 + 965j),
    (606 + 630j, 552 + 790j, 546 + 965j),
)
_NEAR_LEGS = (
    (426 + 640j, 424 + 805j, 414 + 985j),
    (630 + 620j, 658 + 805j, 642 + 985j),
)
_KNEE = 808  # below it, the legs have no patches


def _patches(where: BaseGeometry) -> list[Mark]:
    """Rounded Voronoi cells of seeds that lie closer together on the neck and the legs."""
    rng = np.random.default_rng(15)
    left, top, right, bottom = where.bounds
    seeds: list[complex] = []
    for x, y in rng.uniform((left - 40, top - 40), (right + 40, bottom + 40), (5000, 2)):
        spacing = np.interp(y, (150, 480, 640, 800), (44, 74, 78, 44))
        if all(abs(x + 1j * y - seed) > spacing for seed in seeds):
            seeds.append(complex(x, y))
    cells = shapely.voronoi_polygons(shapely.MultiPoint([(z.real, z.imag) for z in seeds]))
    rims = [rounded(cell.buffer(-6.5), 11) for cell in cells.geoms]
    return [Mark(rim, _PATCH) for rim in rims if rim.intersection(where).area > 0.35 * rim.area]


def _leg(hip: complex, knee: complex, ankle: complex, *, thigh: float) -> BaseGeometry:
    joints = [hip, (hip + knee) / 2, knee, (knee + ankle) / 2, ankle]
    return ribbon(joints, [thigh, 66, 50, 36, 40]).shape


def _hoof(ankle: complex) -> BaseGeometry:
    top, bottom = ankle - 12j, ankle + 26j
    sides = (
        [bottom - 30, bottom - 27 - 16j, top - 20],
        [top - 20, top + 20],
        [top + 20, bottom + 26],
    )
    return rounded(leaf(*sides, [bottom + 26, bottom - 30]), 5)


def _mane(neck: Ribbon) -> BaseGeometry:
    """Tufts along the back of the neck, the tips bent towards the body."""
    notches = np.linspace(0.98, 0.2, 11)
    roots = neck.at(notches, 0.6)
    outwards = 1j * neck.heading(notches) * np.interp(notches, (0.2, 0.4), (0.55, 1.0))
    valleys = neck.at(notches, 1.0) + 14 * outwards
    tips = (valleys[:-1] + 2 * valleys[1:]) / 3 + 26 * outwards[1:]
    sides = [[roots[-1], roots[0]], [roots[0], valleys[0]]]
    for valley, tip, following in zip(valleys, tips, valleys[1:], strict=False):
        bulge = (valley + tip) / 2 + 0.2j * (valley - tip)
        sides += [[valley, bulge, tip], [tip, following]]
    return rounded(leaf(*sides, [valleys[-1], roots[-1]]), 3)


def _tail(canvas: Canvas) -> None:
    tail = ribbon([664 + 560j, 728 + 596j, 764 + 676j, 766 + 756j], [30, 20, 15, 14])
    canvas.form(tail.shape, _HIDE)
    tuft = leaf([757 + 738j, 736 + 800j, 762 + 874j], [762 + 874j, 802 + 812j, 775 + 738j])
    canvas.form(tuft, _MANE)


def _far_legs(canvas: Canvas) -> None:
    for joints in _FAR_LEGS:
        leg = _leg(*joints, thigh=100)
        coat = leg.intersection(shapely.box(0, 0, 840, _KNEE))
        canvas.form(leg, _HIDE, *_patches(coat), dim=0.6, gloss=0)
        canvas.form(_hoof(joints[-1]), _HOOF, dim=0.6, gloss=0)


def _body(canvas: Canvas) -> None:
    """Neck, trunk and near legs in one piece, so that the legs grow out of the trunk."""
    neck = ribbon(
        [430 + 600j, 372 + 480j, 328 + 350j, 296 + 235j, 274 + 160j], [210, 152, 108, 84, 78]
    )
    canvas.form(_mane(neck), _MANE, gloss=0.1)
    trunk = blob(
        332 + 560j, 380 + 490j, 480 + 490j, 600 + 520j, 680 + 580j, 694 + 650j, 630 + 706j,
        510 + 722j, 400 + 716j, 340 + 650j,
    )  # fmt: skip
    legs = [_leg(*joints, thigh=126) for joints in _NEAR_LEGS]
    belly = blob(300 + 720j, 430 + 692j, 570 + 690j, 680 + 720j, 640 + 900j, 380 + 900j)
    body = weld(trunk, neck.shape, *legs, radius=14)
    coat = shapely.union_all([body.difference(belly), *legs])
    patches = _patches(coat.intersection(shapely.box(0, 140, 840, _KNEE)))
    canvas.form(body, _HIDE, *patches)
    for joints in _NEAR_LEGS:
        canvas.form(_hoof(joints[-1]), _HOOF)


def _head(canvas: Canvas) -> None:
    for foot, tip in ((298 + 106j, 318 + 42j), (248 + 106j, 244 + 38j)):
        canvas.form(ribbon([foot, tip], [26, 18]).shape, _HIDE)
        canvas.form(ellipse(tip, 18, 16), _MANE)
    ear = leaf([312 + 128j, 360 + 88j, 416 + 100j], [416 + 100j, 390 + 146j, 318 + 160j])
    canvas.form(ear, _HIDE, Mark(ear.buffer(-9), "#f5a07c"))
    head = blob(
        254 + 86j, 310 + 100j, 334 + 162j, 302 + 224j, 242 + 246j, 190 + 272j, 136 + 270j,
        106 + 232j, 130 + 190j, 186 + 154j, 212 + 106j,
    )  # fmt: skip
    marks = [
        Mark(ellipse(144 + 236j, 66, 54, -20), _CREAM, 1.0, 4),
        Mark(ellipse(252 + 208j, 25, 17), "#ff8a68", 0.65, 6),
        *(
            Mark(ellipse(z, r, 0.8 * r, 30), _PATCH)
            for z, r in ((310 + 186j, 15), (316 + 150j, 9), (286 + 218j, 9))
        ),
    ]
    canvas.form(head, _HIDE, *marks)
    canvas.flat(ellipse(126 + 212j, 6, 9, 30), INK)
    canvas.line([120 + 248j, 156 + 256j, 190 + 246j, 210 + 222j], 6)
    eye(canvas, 236 + 154j, 27, "#7a4526", look=-6 + 2j)
    for lash in ((256 + 126j, 272 + 108j), (264 + 136j, 284 + 122j)):
        canvas.line([lash[0], (lash[0] + lash[1]) / 2 + 3j, lash[1]], 6)


def giraffe() -> Canvas:
    """Draw the giraffe."""
    canvas = Canvas(840, 1100)
    _tail(canvas)
    _far_legs(canvas)
    _body(canvas)
    _head(canvas)
    return canvas
