"""What is typed while the pointer drags in the viewport."""

from collections.abc import Callable

from imgui_bundle import ImVec2, imgui

from app.editor import EntryMark
from app.editor.tools import ERASE
from app.ui.style import Look, ink

DIGITS = "0123456789.,-"
AXES = ((imgui.Key.x, "x"), (imgui.Key.y, "y"))


def typed() -> str:
    """Return what was typed for a drag in this frame, in the order in which it counts."""
    characters = [chr(code) for code in imgui.get_io().input_queue_characters]
    text = "".join(character for character in characters if character in DIGITS)
    # By their keys: a character is repeated while its key is held, and would let the axis go again.
    text += "".join(axis for key, axis in AXES if imgui.is_key_pressed(key, repeat=False))
    return text + (ERASE if imgui.is_key_pressed(imgui.Key.backspace) else "")


def draw_entry(look: Look, mark: EntryMark, point: Callable[[complex], ImVec2]) -> None:
    """Draw the axis that a drag keeps to, and beside the pointer what was typed."""
    draw_list, palette, em = imgui.get_window_draw_list(), look.palette, look.em
    corner, room = imgui.get_window_pos(), imgui.get_window_size()
    if mark.direction is not None:
        centre = point(mark.place)
        low, high = centre, centre
        if mark.direction.real:
            low, high = ImVec2(corner.x, centre.y), ImVec2(corner.x + room.x, centre.y)
        else:
            low, high = ImVec2(centre.x, corner.y), ImVec2(centre.x, corner.y + room.y)
        # Dark below light, so that it shows on any drawing.
        draw_list.add_line(low, high, ink(palette.desk, 0.5), 0.26 * em)
        draw_list.add_line(low, high, ink(palette.accent), 0.12 * em)
    mouse, size = imgui.get_mouse_pos(), imgui.calc_text_size(mark.text)
    left = min(max(mouse.x + em, corner.x), corner.x + room.x - size.x - em)
    top = min(max(mouse.y + em, corner.y), corner.y + room.y - 1.4 * em)
    low, high = ImVec2(left, top), ImVec2(left + size.x + em, top + 1.4 * em)
    draw_list.add_rect_filled(low, high, ink(palette.accent), 0.3 * em)
    place = ImVec2(left + em / 2, top + (1.4 * em - size.y) / 2)
    draw_list.add_text(place, ink(palette.on_accent), mark.text)
