"""What is drawn over pictures and tracks in the same way everywhere."""

from imgui_bundle import ImVec2, ImVec4, imgui

from app.ui.style.theme import Look, colour_u32

EDGE = 0.07  # em of darkness on each side of a line or a knob
TAG = 1.4  # em: height of a tag


def outline_strokes(
    look: Look, colour: int, width: float
) -> tuple[tuple[int, float], tuple[int, float]]:
    """Return the inks and widths of a line, dark below light, so that it shows on any drawing.

    Parameters
    ----------
    colour : int
        Of the upper one, as draw lists take it.
    width : float
        Of the upper one, in em; those that are returned are in pixels.
    """
    below = colour_u32(look.palette.desk, 0.5), (width + 2 * EDGE) * look.em
    return below, (colour, width * look.em)


def draw_knob(look: Look, centre: ImVec2, radius: float, colour: ImVec4) -> None:
    """Draw a disc with a dark rim; the radius is in em."""
    draw_list = imgui.get_window_draw_list()
    draw_list.add_circle_filled(
        centre, (radius + 0.1) * look.em, colour_u32(look.palette.desk, 0.7)
    )
    draw_list.add_circle_filled(centre, radius * look.em, colour_u32(colour))


def draw_centred_text(low: ImVec2, high: ImVec2, text: str, colour: int) -> None:
    """Write a text into the middle of a box."""
    corner = (low + high - imgui.calc_text_size(text)) / 2
    imgui.get_window_draw_list().add_text(corner, colour, text)


def tag_size(look: Look, text: str) -> ImVec2:
    """Return the width and height of a tag in pixels."""
    return ImVec2(imgui.calc_text_size(text).x + look.em, TAG * look.em)


def draw_tag(look: Look, corner: ImVec2, text: str) -> None:
    """Write something short on the accent colour, over what is dragged."""
    opposite, palette = corner + tag_size(look, text), look.palette
    draw_list = imgui.get_window_draw_list()
    draw_list.add_rect_filled(corner, opposite, colour_u32(palette.accent), 0.3 * look.em)
    draw_centred_text(corner, opposite, text, colour_u32(palette.on_accent))
