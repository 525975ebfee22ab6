"""Fields for the width and the height of pictures."""

from typing import NamedTuple

from imgui_bundle import imgui

from app.texts import _
from app.ui.style.widgets import draw_tooltip

LARGEST = 65_535


class EnteredSize(NamedTuple):
    """A size in pixels, and whether the width was entered."""

    size: tuple[int, int]
    by_width: bool


def draw_size_fields(name: str, size: tuple[int, int], room: float) -> EnteredSize | None:
    """Draw two fields, and leave `room` pixels beside them. Return an entered size."""
    gap = imgui.get_style().item_inner_spacing.x
    times = imgui.calc_text_size("×").x
    each = (imgui.get_content_region_avail().x - room - times - 2 * gap) / 2
    entered = list(size)
    ended = []
    for side, (word, hint) in enumerate(
        (("width", _("Width in pixels")), ("height", _("Height in pixels")))
    ):
        imgui.set_next_item_width(each)
        entered[side] = imgui.input_int(f"##{name}{word}", size[side], 0)[1]
        ended.append(imgui.is_item_deactivated_after_edit())
        draw_tooltip(hint)
        if not side:
            imgui.same_line(0, gap)
            imgui.text_disabled("×")
            imgui.same_line(0, gap)
    if not any(ended):
        return None
    wide, high = (min(max(side, 1), LARGEST) for side in entered)
    return EnteredSize((wide, high), ended[0])
