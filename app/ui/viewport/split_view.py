"""Two methods in one viewport: on both sides of a divider, or side by side."""

from typing import NamedTuple

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import Baseline, Variant
from app.editor import Action, Project, Session, do
from app.editor.actions import viewing
from app.texts import _
from app.ui.methods import METHODS
from app.ui.style.drawing import draw_centred_text, draw_knob, outline_strokes
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import draw_tooltip, is_hovered_or_held

GRIP, LINE = 0.55, 0.12  # em: half the width of the divider's hit area, and half the line's width
KNOB = 0.85  # em: radius of the visible grip


class SplitTextures(NamedTuple):
    """OpenGL's names of the picture, and of the compared method's picture or None."""

    own: int | None = None
    comparison: int | None = None


class SplitLayout(NamedTuple):
    """The two pictures on the screen: corner and size of each.

    `room` is the space of the drawing's own picture, with handles and overlays.
    """

    corner: ImVec2
    room: ImVec2
    divider: float


def divide_viewport(session: Session, corner: ImVec2, room: ImVec2) -> SplitLayout:
    split = session.display.compare_view
    if split is None or session.tools.is_cutting:
        return SplitLayout(corner, room, corner.x + room.x)
    if split.is_side_by_side:
        half = ImVec2(room.x / 2, room.y)
        return SplitLayout(corner, half, corner.x + half.x)
    return SplitLayout(corner, room, corner.x + split.divider * room.x)


def draw_split_pictures(parts: SplitLayout, own: int, comparison: int | None) -> None:
    """Show the drawing, and right of the divider the compared method's picture."""
    draw_list = imgui.get_window_draw_list()
    corner, room = parts.corner, parts.room
    bottom = corner.y + room.y
    draw_list.add_image(
        imgui.ImTextureRef(own),
        corner,
        ImVec2(corner.x + room.x, bottom),
        ImVec2(0, 1),
        ImVec2(1, 0),
    )
    if comparison is None:
        return
    is_beside = parts.divider >= corner.x + room.x
    left = 0.0 if is_beside else (parts.divider - corner.x) / room.x
    end = parts.divider + room.x if is_beside else corner.x + room.x
    draw_list.add_image(
        imgui.ImTextureRef(comparison),
        ImVec2(parts.divider, corner.y),
        ImVec2(end, bottom),
        ImVec2(left, 1),
        ImVec2(1, 0),
    )


def draw_divider(session: Session, look: Look, parts: SplitLayout, room: float) -> list[Action]:
    """Draw the divider with the methods' names. Dragging moves it.

    Call it before the canvas: the first item under the pointer takes the press.
    """
    split, project = session.display.compare_view, session.project
    if split is None or project is None or session.tools.is_cutting:
        return []
    actions: list[Action] = []
    x, top, height = parts.divider, parts.corner.y, parts.room.y
    draw_list = imgui.get_window_draw_list()
    is_hot = False
    if not split.is_side_by_side:
        imgui.set_cursor_screen_pos(ImVec2(x - GRIP * look.em, top))
        imgui.invisible_button("divider", ImVec2(2 * GRIP * look.em, height))
        is_hot = is_hovered_or_held()
        if is_hot:
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        if imgui.is_item_active() and imgui.get_io().mouse_delta.x:
            place = (imgui.get_mouse_pos().x - parts.corner.x) / room
            actions.append(do(viewing.move_comparison_divider, place))
        draw_tooltip(_("Drag to compare"))
    palette = look.palette
    colour = palette.accent if is_hot else palette.text
    for tone, width in outline_strokes(look, colour_u32(colour), LINE):
        draw_list.add_line(ImVec2(x, top), ImVec2(x, top + height), tone, width)
    if not split.is_side_by_side:
        knob = ImVec2(x, top + height / 2)
        draw_knob(look, knob, KNOB, colour)
        draw_centred_text(knob, knob, icons.ICON_FA_LEFT_RIGHT, colour_u32(palette.on_accent))
    _names(look, project, split.method, x, top)
    return actions


def _names(look: Look, project: Project, method: Variant | Baseline, x: float, top: float) -> None:
    """Write the names of the methods left and right of the divider."""
    pad = 0.5 * look.em
    own = METHODS[project.layer.variant].name
    other = METHODS[method].name
    draw_list = imgui.get_window_draw_list()
    for text, left in ((own, x - imgui.calc_text_size(own).x - 3 * pad), (other, x + 3 * pad)):
        size = imgui.calc_text_size(text)
        low = ImVec2(left - pad, top + pad)
        high = ImVec2(left + size.x + pad, top + size.y + 2 * pad)
        draw_list.add_rect_filled(low, high, colour_u32(look.palette.desk, 0.8), 0.3 * look.em)
        draw_list.add_text(ImVec2(left, top + 1.5 * pad), colour_u32(look.palette.text), text)
