"""Fields for the width and the height of pictures."""

from collections.abc import Callable
from typing import NamedTuple

from imgui_bundle import ImVec2, imgui, imgui_ctx

from app.texts import _
from app.ui.style.widgets import TIGHT, draw_tooltip

LARGEST = 65_535


class EnteredSize(NamedTuple):
    """A size in pixels, and whether the width was entered."""

    size: tuple[int, int]
    by_width: bool


def draw_size_fields(
    name: str,
    size: tuple[int, int],
    room: float,
    between: tuple[Callable[[], None], float] | None = None,
) -> EnteredSize | None:
    """Draw two fields, and leave `room` pixels beside them. Return an entered size.

    `between` draws what stands between them, and is so many pixels wide; by default a cross.
    """
    gap = imgui.get_style().item_inner_spacing.x
    draw, width = between or (lambda: imgui.text_disabled("×"), imgui.calc_text_size("×").x)
    each = (imgui.get_content_region_avail().x - room - width - 2 * gap) / 2
    # Five digits fit in the smallest panel.
    padding = ImVec2(TIGHT * imgui.get_font_size(), imgui.get_style().frame_padding.y)
    entered = list(size)
    ended = []
    for side, (word, hint) in enumerate(
        (("width", _("Width in pixels")), ("height", _("Height in pixels")))
    ):
        imgui.set_next_item_width(each)
        with imgui_ctx.push_style_var(imgui.StyleVar_.frame_padding, padding):
            entered[side] = imgui.input_int(f"##{name}{word}", size[side], 0)[1]
        ended.append(imgui.is_item_deactivated_after_edit())
        draw_tooltip(hint)
        if not side:
            imgui.same_line(0, gap)
            draw()
            imgui.same_line(0, gap)
    if not any(ended):
        return None
    wide, high = (min(max(side, 1), LARGEST) for side in entered)
    return EnteredSize((wide, high), ended[0])
