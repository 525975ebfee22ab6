"""Shapes that overlays, tracks and gizmos share."""

from imgui_bundle import ImVec2, ImVec4, imgui

from app.ui.style.theme import Look, colour_u32

EDGE = 0.07  # em: width of the dark edge on each side of a line or a knob
TAG = 1.4  # em: height of a tag


def outline_strokes(
    look: Look, colour: int, width: float
) -> tuple[tuple[int, float], tuple[int, float]]:
    """Return colour and width in pixels of two lines, dark below light: visible on any drawing.

    Parameters
    ----------
    width : float
        Of the upper line, in em.
    """
    below = colour_u32(look.palette.desk, 0.5), (width + 2 * EDGE) * look.em
    return below, (colour, width * look.em)


def draw_knob(look: Look, centre: ImVec2, radius: float, colour: ImVec4) -> None:
    """Draw a disc with a dark rim. The radius is in em."""
    draw_list = imgui.get_window_draw_list()
    draw_list.add_circle_filled(
        centre, (radius + 0.1) * look.em, colour_u32(look.palette.desk, 0.7)
    )
    draw_list.add_circle_filled(centre, radius * look.em, colour_u32(colour))


def draw_centred_text(low: ImVec2, high: ImVec2, text: str, colour: int) -> None:
    corner = (low + high - imgui.calc_text_size(text)) / 2
    imgui.get_window_draw_list().add_text(corner, colour, text)


def tag_size(look: Look, text: str) -> ImVec2:
    """The size of a tag in pixels."""
    return ImVec2(imgui.calc_text_size(text).x + look.em, TAG * look.em)


def draw_tag(look: Look, corner: ImVec2, text: str) -> None:
    """Draw a short text on the accent colour, above a dragged item."""
    opposite, palette = corner + tag_size(look, text), look.palette
    draw_list = imgui.get_window_draw_list()
    draw_list.add_rect_filled(corner, opposite, colour_u32(palette.accent), 0.3 * look.em)
    draw_centred_text(corner, opposite, text, colour_u32(palette.on_accent))


def show_picture(
    texture: int, size: tuple[int, int], corner: ImVec2, room: ImVec2, *, opacity: float = 1.0
) -> None:
    """Draw a texture centred in a box, as large as fits. `size` is in pixels."""
    scale = min(room.x / size[0], room.y / size[1])
    width, height = scale * size[0], scale * size[1]
    x = corner.x + (room.x - width) / 2
    y = corner.y + (room.y - height) / 2
    imgui.get_window_draw_list().add_image(
        imgui.ImTextureRef(texture),
        ImVec2(x, y),
        ImVec2(x + width, y + height),
        col=imgui.IM_COL32(255, 255, 255, round(255 * opacity)),
    )
