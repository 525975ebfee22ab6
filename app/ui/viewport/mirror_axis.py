"""The upright axis at which poses are flipped, and the grip by which it is moved."""

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.ui.style import Look, ink, tip

TOP, RADIUS = 3.2, 0.85  # em: of the grip, below the edge; its size
DASH, GAP = 0.6, 0.45  # em


def axis_grip(look: Look, x: float) -> tuple[bool, bool]:
    """Lay a button over the grip at a place of the screen; tell whether it is hot, and pressed."""
    centre = _grip(look, x)
    radius = RADIUS * look.em
    imgui.set_cursor_screen_pos((centre.x - radius, centre.y - radius))
    imgui.invisible_button("mirror axis", (2 * radius, 2 * radius))
    hot = imgui.is_item_hovered() or imgui.is_item_active()
    if hot:
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
    tip("Poses are flipped here: drag it where the drawing has its middle")
    pressed = imgui.is_item_activated() and imgui.is_mouse_clicked(imgui.MouseButton_.left)
    return hot, pressed


def draw_axis(look: Look, x: float, *, hot: bool) -> None:
    """Draw the axis from top to bottom, with its grip."""
    draw_list, palette, em = imgui.get_window_draw_list(), look.palette, look.em
    top = imgui.get_window_pos().y
    bottom = top + imgui.get_window_size().y
    colour = palette.accent if hot else palette.text
    y = top
    while y < bottom:
        begin, end = ImVec2(x, y), ImVec2(x, min(y + DASH * em, bottom))
        # Dark below light, so that it shows on any drawing.
        draw_list.add_line(begin, end, ink(palette.desk, 0.5), 0.22 * em)
        draw_list.add_line(begin, end, ink(colour, 0.8), 0.1 * em)
        y += (DASH + GAP) * em
    centre = _grip(look, x)
    draw_list.add_circle_filled(centre, (RADIUS + 0.1) * em, ink(palette.desk, 0.7))
    draw_list.add_circle_filled(centre, RADIUS * em, ink(palette.accent))
    size = imgui.calc_text_size(icons.ICON_FA_ARROWS_LEFT_RIGHT)
    place = ImVec2(centre.x - size.x / 2, centre.y - size.y / 2)
    draw_list.add_text(place, ink(palette.on_accent), icons.ICON_FA_ARROWS_LEFT_RIGHT)


def _grip(look: Look, x: float) -> ImVec2:
    return ImVec2(x, imgui.get_window_pos().y + TOP * look.em)
