"""The button beside a property that can be keyed."""

from typing import Any

from imgui_bundle import ImVec2, imgui

from app.document import Channel, Document, frames_in, source_frame
from app.editor import Action, do
from app.editor.actions.timing import channel_keys
from app.texts import _
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import draw_tooltip, is_hovered_or_held

SIZE, HALF = 1.3, 0.38  # em: width of the button, and half the diagonal of the diamond


def draw_key_diamond(
    document: Document, look: Look, channel: Channel[Any], frame: int
) -> list[Action]:
    """Draw a diamond at the end of the line: filled on a key, hollow beside keys.

    A click deletes the key at the frame, or inserts one with the present value.
    """
    frames = frames_in(document, channel)
    is_keyed = source_frame(document, channel, frame) in frames
    imgui.same_line(0, 0.3 * look.em)
    corner, height = imgui.get_cursor_screen_pos(), imgui.get_frame_height()
    size = ImVec2(SIZE * look.em, height)
    clicked = imgui.invisible_button(f"key {channel.kind.name}", size)
    palette, draw_list = look.palette, imgui.get_window_draw_list()
    colour = palette.accent if frames or is_hovered_or_held() else palette.dim
    x, y, half = corner.x + size.x / 2, corner.y + height / 2, HALF * look.em
    points = (ImVec2(x, y - half), ImVec2(x + half, y), ImVec2(x, y + half), ImVec2(x - half, y))
    if is_keyed:
        draw_list.add_quad_filled(*points, colour_u32(colour))
    else:
        draw_list.add_quad(*points, colour_u32(colour), 1.5)
    hint = _("Delete the key at this frame") if is_keyed else _("Set a key at this frame")
    draw_tooltip(f"{_(channel.kind.label)}: {hint}")
    if not clicked:
        return []
    verb = channel_keys.delete_channel_key if is_keyed else channel_keys.insert_channel_key
    return [do(verb, channel)]


def diamond_room(look: Look) -> float:
    """Return the width, in pixels, that a diamond takes at the end of a line."""
    return (SIZE + 0.3) * look.em
