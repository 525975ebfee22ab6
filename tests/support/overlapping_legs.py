"""A person seen from the side whose near leg is drawn over the far leg."""

from typing import Literal

import numpy as np
import shapely
from PIL import Image, ImageDraw

SIZE = (300, 520)
SMOOTH = 3
INK, NEAR, FAR, SKIN = (20, 20, 24), (90, 120, 190), (60, 84, 140), (240, 205, 170)
NEAR_LEG = ((138, 250, 30), (130, 150, 23), (112, 52, 18), (112, 36, 17), (142, 30, 12))
FAR_LEG = ((148, 250, 28), (160, 150, 22), (172, 52, 18), (172, 36, 17), (204, 30, 12))
BODY = ((140, 340, 34), (140, 260, 32))
HEAD = ((148, 428, 50),)
NOSE = ((190, 424, 14), (206, 420, 6))
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
    width, height = SIZE
    image = Image.new("RGBA", (width * SMOOTH, height * SMOOTH))
    pen = ImageDraw.Draw(image)

    def fill(shape: shapely.Geometry, colour: tuple[int, int, int]) -> None:
        for part in shapely.get_parts(shape):
            xy = shapely.get_coordinates(part.exterior) * [1, -1] + [0, height]
            pen.polygon([tuple(point) for point in xy * SMOOTH], fill=(*colour, 255))

    far = NEAR if style == "plain" else FAR
    parts = [(FAR_LEG, far), (BODY, SKIN), (NEAR_LEG, NEAR), (NOSE, SKIN), (HEAD, SKIN)]
    for discs, colour in parts:
        shape = limb(*discs)
        if style == "lines":
            fill(shape.buffer(2), INK)
            shape = shape.buffer(-2)
        fill(shape, colour)
    return image.resize(SIZE, Image.Resampling.LANCZOS)


def rgba_of(image: Image.Image) -> np.ndarray[tuple[int, int, int], np.dtype[np.uint8]]:
    return np.asarray(image)
