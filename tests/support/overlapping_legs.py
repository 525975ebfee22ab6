"""Persons whose limbs touch in the drawing: legs from the side, arms and trunk from the front."""

from typing import Literal

import numpy as np
import shapely
from PIL import Image, ImageDraw

SIZE = (300, 520)
SMOOTH = 3
Discs = tuple[tuple[float, float, float], ...]
INK, NEAR, FAR, SKIN = (20, 20, 24), (90, 120, 190), (60, 84, 140), (240, 205, 170)
NEAR_LEG = ((138, 250, 30), (130, 150, 23), (112, 52, 18), (112, 36, 17), (142, 30, 12))
FAR_LEG = ((148, 250, 28), (160, 150, 22), (172, 52, 18), (172, 36, 17), (204, 30, 12))
BODY = ((140, 340, 34), (140, 260, 32))
HEAD = ((148, 428, 50),)
NOSE = ((190, 424, 14), (206, 420, 6))
# From the front, with lowered arms behind the trunk.
FRONT_LEGS = [
    ((150 + x, 260, 30), (150 + 1.1 * x, 150, 24), (150 + 1.2 * x, 40, 18)) for x in (-32, 32)
]
SHOULDER = 98 + 372j  # of the right arm, on the left of the picture
FRONT_ARMS = [
    ((150 + x, 372, 20), (150 + 1.75 * x, 290, 16), (150 + 2.1 * x, 215, 15)) for x in (-52, 52)
]
FRONT_TRUNK = ((150, 360, 56), (150, 270, 50))
FRONT_HEAD = ((150, 425, 20), (150, 470, 42))
# From the side, over the trunk; the shoulder has no line across.
NEAR_ARM = ((138, 350, 15), (130, 300, 13), (146, 256, 12))
BENT_ARM = ((136, 350, 15), (126, 300, 13), (206, 286, 11))
JOINTS = {
    "hips": 142 + 262j,
    "chest": 140 + 345j,
    "neck": 142 + 378j,
    "head": 148 + 430j,
    "hip.R": 137 + 240j,
    "knee.R": 130 + 145j,
    "foot.R": 112 + 44j,
    "hip.L": 152 + 240j,
    "knee.L": 161 + 145j,
    "foot.L": 172 + 44j,
}


def limb(*discs: tuple[float, float, float]) -> shapely.Polygon:
    """Return the shape around discs (x, y, radius) in a row, y up."""
    round_ends = [shapely.Point(x, y).buffer(radius) for x, y, radius in discs]
    pairs = zip(round_ends, round_ends[1:] or round_ends, strict=False)
    return shapely.union_all([shapely.union(*pair).convex_hull for pair in pairs])


def draw_person(style: Literal["lines", "flat", "plain"]) -> Image.Image:
    """Draw a person: with outlines, in flat colours, or legs of one colour without a line."""
    far = NEAR if style == "plain" else FAR
    parts = [(FAR_LEG, far), (BODY, SKIN), (NEAR_LEG, NEAR), (NOSE, SKIN), (HEAD, SKIN)]
    return _drawn(parts, has_lines=style == "lines")


def draw_long_toes() -> Image.Image:
    """Draw a person from the side, with outlines, whose near toes cover the far ankle."""
    near = (*NEAR_LEG[:-1], (184, 28, 12))
    far = (*FAR_LEG[:-1], (236, 30, 12))
    parts = [(far, FAR), (BODY, SKIN), (near, NEAR), (NOSE, SKIN), (HEAD, SKIN)]
    return _drawn(parts, has_lines=True)


def draw_arm(style: Literal["lines", "flat"], arm: Discs = NEAR_ARM) -> Image.Image:
    """Draw a person from the side with the near arm over the trunk, or without one if it is ()."""
    wide = (140, 340, 46), (140, 262, 42)
    parts = [(FAR_LEG, FAR), (NEAR_LEG, NEAR), (wide, SKIN), (NOSE, SKIN), (HEAD, SKIN)]
    if not arm:
        return _drawn(parts, has_lines=style == "lines")
    if style == "flat":
        return _drawn([*parts, (arm, FAR)], has_lines=False)
    image = _drawn([*parts, (arm, SKIN)], has_lines=True, size=3)
    (x, y, radius), height = arm[0], SIZE[1]
    over = [SMOOTH * each for each in (x - radius, height - y - 2 * radius, x + radius, height - y)]
    ImageDraw.Draw(image).ellipse(over, fill=(*SKIN, 255))
    return image.resize(SIZE, Image.Resampling.LANCZOS)


def draw_front(*, has_lines: bool, arms_in_front: bool = False) -> Image.Image:
    """Draw a person from the front, with outlines or in a single colour."""
    arms, trunk = FRONT_ARMS, [FRONT_TRUNK]
    above = [*trunk, *arms] if arms_in_front else [*arms, *trunk]
    parts = [*FRONT_LEGS, *above, FRONT_HEAD]
    return _drawn([(discs, NEAR) for discs in parts], has_lines=has_lines)


def _drawn(
    parts: list[tuple[Discs, tuple[int, int, int]]], *, has_lines: bool, size: int = 1
) -> Image.Image:
    """Draw shapes; `size` times as large."""
    width, height = SIZE
    image = Image.new("RGBA", (width * SMOOTH, height * SMOOTH))
    pen = ImageDraw.Draw(image)

    def fill(shape: shapely.Geometry, colour: tuple[int, int, int]) -> None:
        for part in shapely.get_parts(shape):
            xy = shapely.get_coordinates(part.exterior) * [1, -1] + [0, height]
            pen.polygon([tuple(point) for point in xy * SMOOTH], fill=(*colour, 255))

    for discs, colour in parts:
        shape = limb(*discs)
        if has_lines:
            fill(shape.buffer(2), INK)
            shape = shape.buffer(-2)
        fill(shape, colour)
    return image.resize((size * width, size * height), Image.Resampling.LANCZOS)


def rgba_of(image: Image.Image) -> np.ndarray[tuple[int, int, int], np.dtype[np.uint8]]:
    return np.asarray(image)
