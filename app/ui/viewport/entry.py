"""What is typed while the pointer drags in the viewport."""

from collections.abc import Callable

from imgui_bundle import ImVec2, imgui

from app.editor import EntryMark
from app.editor.tools import ERASE
from app.ui.style import Look, ink, outlined, tag_size, write_tag

LINE = 0.12  # em
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
    corner, room = imgui.get_window_pos(), imgui.get_window_size()
    if mark.direction is not None:
        centre = point(mark.place)
        low, high = centre, centre
        if mark.direction.real:
            low, high = ImVec2(corner.x, centre.y), ImVec2(corner.x + room.x, centre.y)
        else:
            low, high = ImVec2(centre.x, corner.y), ImVec2(centre.x, corner.y + room.y)
        for tone, width in outlined(look, ink(look.palette.accent), LINE):
            imgui.get_window_draw_list().add_line(low, high, tone, width)
    mouse, last = imgui.get_mouse_pos(), corner + room - tag_size(look, mark.text)
    left = min(max(mouse.x + look.em, corner.x), last.x)
    top = min(max(mouse.y + look.em, corner.y), last.y)
    write_tag(look, ImVec2(left, top), mark.text)
