"""A picture of a domain: the drawing with its mesh, outlines and cages."""

import io

import numpy as np
from PIL import Image, ImageDraw

from app.storage import Picture
from engine.arrays import Complexes
from engine.domain import MeshedDomain

LONG_SIDE = 1600  # pixels of the preview
SUPERSAMPLING = 2
PAPER, CHECK = (250, 249, 246, 255), (232, 231, 227, 255)
MESH_COLOUR, OUTLINE_COLOUR, CAGE_COLOUR = (30, 40, 60, 70), (0, 120, 215, 255), (235, 94, 40, 255)


def draw_preview(picture: Picture, domain: MeshedDomain) -> bytes:
    """Return a PNG of the picture on a checkerboard, its mesh, outlines (blue) and cages (orange).

    The domain is in the pixels of the picture, y up.
    """
    everything = np.concatenate([domain.cage, [0, complex(*picture.size)]])
    left, top = everything.real.min(), everything.imag.max()
    extent = max(float(np.ptp(everything.real)), float(np.ptp(everything.imag)))
    margin = 0.02 * extent
    scale = SUPERSAMPLING * LONG_SIDE / (extent + 2 * margin)

    def place(points: Complexes) -> list[tuple[float, float]]:
        x = (points.real - left + margin) * scale
        y = (top + margin - points.imag) * scale
        return list(zip(x.tolist(), y.tolist(), strict=True))

    size = tuple(
        max(SUPERSAMPLING, round((float(np.ptp(axis)) + 2 * margin) * scale))
        for axis in (everything.real, everything.imag)
    )
    canvas = _checkerboard((size[0], size[1]))
    width, height = picture.size
    corner = place(np.array([1j * height]))[0]
    drawn = Image.fromarray(picture.rgba).resize(
        (max(1, round(width * scale)), max(1, round(height * scale)))
    )
    canvas.alpha_composite(drawn, (round(corner[0]), round(corner[1])))

    lines = Image.new("RGBA", canvas.size)
    pen = ImageDraw.Draw(lines)
    ends = place(domain.mesh.vertices)
    for start, end in domain.mesh.edges().tolist():
        pen.line((*ends[start], *ends[end]), fill=MESH_COLOUR)
    canvas.alpha_composite(lines)
    pen = ImageDraw.Draw(canvas)
    coloured = [(cage, CAGE_COLOUR) for cage in domain.cages]
    coloured += [(loop, OUTLINE_COLOUR) for loop in domain.loops]
    for polygon, colour in coloured:
        corners = place(polygon)
        pen.line([*corners, corners[0]], fill=colour, width=2 * SUPERSAMPLING)
        for x, y in corners:
            r = 3 * SUPERSAMPLING
            pen.ellipse((x - r, y - r, x + r, y + r), fill=colour)
    stream = io.BytesIO()
    canvas.reduce(SUPERSAMPLING).convert("RGB").save(stream, "PNG", compress_level=6)
    return stream.getvalue()


def _checkerboard(size: tuple[int, int]) -> Image.Image:
    square = 24 * SUPERSAMPLING
    rows, columns = np.indices((-(-size[1] // square), -(-size[0] // square)))
    squares = np.where(((rows + columns) % 2 == 0)[..., None], PAPER, CHECK).astype(np.uint8)
    board = Image.fromarray(squares).resize(
        (squares.shape[1] * square, squares.shape[0] * square), Image.Resampling.NEAREST
    )
    return board.crop((0, 0, *size))
