"""The surroundings of the drawing: the backdrop behind it, and the area outside the camera's frame.

The backdrop is a chosen colour, or a checker with enough contrast to the drawing.
"""

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui

from app.document import camera_at
from app.editor import Project
from app.render import Backdrop
from app.storage import CHECKER
from app.ui.style.theme import PALETTES, Look, Palette, colour_u32, rgb
from app.ui.viewport.marks import to_rgba
from app.ui.viewport.screen import ScreenMapping
from engine.arrays import Bytes, Floats

SQUARE = 12.0  # pixels at a scale of 1
LEVELS = 256
# NEAR: difference of brightness, 0 to 1, below which the drawing's edge is hard to see.
# MUCH: share of such edge above which another checker is taken.
NEAR, MUCH = 0.2, 0.5
LUMA = np.array([0.2126, 0.7152, 0.0722])  # weights of red, green and blue, as in Rec. 709
RIM = 0.006  # width of the edge that is measured, in sizes of the picture
OPAQUE = 128  # alpha
# The two squares of a grey checker, on which both dark and light edges are visible.
GREY = rgb("5f626a"), rgb("595c63")
DIM = 0.45  # opacity of the desk's colour outside the camera's frame
FAR = 1e3  # size of the dimmed area, in camera frames: larger than the viewport


def measure_edge(picture: Bytes) -> Floats:
    """Return the brightness histogram along the edge of a picture's (h, w, 4) opaque area.

    Returns
    -------
    (256,) float64
        From black to white, shares of 1.
    """
    width = max(2, round(RIM * max(picture.shape)))
    # What lies beyond the picture is transparent.
    is_opaque = np.pad(picture[..., 3] >= OPAQUE, width)
    shifted = (np.roll(is_opaque, by, axis) for by in (-width, width) for axis in (0, 1))
    is_inside = np.logical_and.reduce(list(shifted))
    is_edge = (is_opaque & ~is_inside)[width:-width, width:-width]
    levels = np.rint(picture[is_edge][:, :3] @ LUMA).astype(np.intp)
    shares = np.bincount(levels, minlength=LEVELS)
    return np.asarray(shares / max(shares.sum(), 1.0))


def make_backdrop(backdrop: str, palette: Palette, edge: Floats, scale: float) -> Backdrop:
    """Return the backdrop. If the theme's checker hides the drawing's edge, take a grey one.

    Parameters
    ----------
    backdrop : str
        "checker" or "#rrggbb".
    edge : (256,) float64
        Brightness along the edge of the drawing.
    scale : float
        Pixels of the screen per pixel of the design.
    """
    if backdrop != CHECKER:
        return Backdrop(colour=to_rgba(rgb(backdrop)))
    own, *others = sorted(PALETTES.values(), key=lambda other: other is not palette)
    checkers = [(own.paper, own.check), GREY, *((each.paper, each.check) for each in others)]
    visible = (each for each in checkers if _lost(edge, each[0]) <= MUCH)
    paper, check = map(to_rgba, next(visible, checkers[0]))
    return Backdrop(colour=paper, checks=check, square=SQUARE * scale)


def _lost(edge: Floats, paper: ImVec4) -> float:
    """Return the share of the drawing's edge that is nearly as bright as the paper."""
    level = float(np.array([paper.x, paper.y, paper.z]) @ LUMA)
    is_near = np.abs(np.arange(LEVELS) / (LEVELS - 1) - level) < NEAR
    return float(edge[is_near].sum())


def draw_camera_frame(
    look: Look, project: Project, screen: ScreenMapping, room: tuple[ImVec2, ImVec2]
) -> None:
    """Draw the camera's frame at the shown frame, if there is a camera.

    Parameters
    ----------
    room : tuple of ImVec2
        The upper left corner of the viewport, and its size.
    """
    shot = camera_at(project.document, screen.shown.frame)
    if shot is None:
        return
    corner, size = room
    draw_list = imgui.get_window_draw_list()
    draw_list.push_clip_rect(corner, corner + size, intersect_with_current_clip_rect=True)
    corners = shot.frame_corners(project.document.canvas)
    inner, outer = (screen.points(shot.centre + by * (corners - shot.centre)) for by in (1.0, FAR))
    # The frame is convex, so its outside is four trapezoids, one beyond each edge. Anti-aliased
    # edges would be visible at the seams; these are sharp.
    dim, white = colour_u32(look.palette.desk, DIM), imgui.get_font_tex_uv_white_pixel()
    for here, there in zip(range(4), np.roll(range(4), -1).tolist(), strict=True):
        draw_list.prim_reserve(6, 4)
        draw_list.prim_quad_uv(
            inner[here],
            outer[here],
            outer[there],
            inner[there],
            white,
            white,
            white,
            white,
            dim,
        )
    for point in inner:
        draw_list.path_line_to(point)
    draw_list.path_stroke(colour_u32(look.palette.accent), 1.5, imgui.ImDrawFlags_.closed)
    draw_list.pop_clip_rect()
