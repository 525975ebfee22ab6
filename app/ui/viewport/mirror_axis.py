"""The upright axis at which poses are flipped, and the grip by which it is moved."""

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.ui.style import Look, draw_knob, in_hand, ink, is_pressed, outlined, tip, write_in

TOP, RADIUS = 3.2, 0.85  # em: of the grip, below the edge; its size
DASH, GAP, LINE = 0.6, 0.45, 0.1  # em


def axis_grip(look: Look, x: float) -> tuple[bool, bool]:
    """Lay a button over the grip at a place of the screen; tell whether it is hot, and pressed."""
    centre = _grip(look, x)
    radius = RADIUS * look.em
    imgui.set_cursor_screen_pos((centre.x - radius, centre.y - radius))
    imgui.invisible_button("mirror axis", (2 * radius, 2 * radius))
    if in_hand():
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
    tip("Poses are flipped here: drag it where the drawing has its middle")
    return in_hand(), is_pressed()


def draw_axis(look: Look, x: float, *, hot: bool) -> None:
    """Draw the axis from top to bottom, with its grip."""
    palette, y = look.palette, imgui.get_window_pos().y
    bottom = y + imgui.get_window_size().y
    colour = ink(palette.accent if hot else palette.text, 0.8)
    while y < bottom:
        end = min(y + DASH * look.em, bottom)
        for tone, width in outlined(look, colour, LINE):
            imgui.get_window_draw_list().add_line((x, y), (x, end), tone, width)
        y += (DASH + GAP) * look.em
    centre = _grip(look, x)
    draw_knob(look, centre, RADIUS, palette.accent)
    write_in(centre, centre, icons.ICON_FA_ARROWS_LEFT_RIGHT, ink(palette.on_accent))


def _grip(look: Look, x: float) -> ImVec2:
    return ImVec2(x, imgui.get_window_pos().y + TOP * look.em)
