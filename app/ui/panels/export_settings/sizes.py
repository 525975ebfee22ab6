"""Fields for the width and the height of pictures."""

from typing import Literal, NamedTuple

from imgui_bundle import ImVec2, imgui, imgui_ctx

from app.texts import _
from app.ui.style.widgets import TIGHT, draw_tooltip

LARGEST = 65_535
HINTS = {"width": _("Width in pixels"), "height": _("Height in pixels")}


class EnteredSide(NamedTuple):
    """A width or a height in pixels, and whether it was entered just now."""

    pixels: int
    is_entered: bool


def side_width(between: float, room: float) -> float:
    """Return the width of each of two fields, with `between` and `room` pixels left."""
    gaps = 2 * imgui.get_style().item_inner_spacing.x
    return (imgui.get_content_region_avail().x - room - between - gaps) / 2


def draw_side(
    side: Literal["width", "height"], pixels: int, width: float, *, name: str = ""
) -> EnteredSide:
    """Draw the field of a width or a height. Five digits fit in the smallest panel."""
    padding = ImVec2(TIGHT * imgui.get_font_size(), imgui.get_style().frame_padding.y)
    imgui.set_next_item_width(width)
    with imgui_ctx.push_style_var(imgui.StyleVar_.frame_padding, padding):
        entered = imgui.input_int(f"##{name}{side}", pixels, 0)[1]
    is_entered = imgui.is_item_deactivated_after_edit()
    draw_tooltip(HINTS[side])
    return EnteredSide(min(max(entered, 1), LARGEST), is_entered)
