"""The few widgets that every panel is made of."""

from collections.abc import Sequence

from imgui_bundle import ImVec2, imgui

from app.ui.style.theme import SMALL, Look

LABEL_WIDTH = 6.2  # em
FILL = -imgui.FLT_MIN  # as a width: the rest of the line
TOAST = "##toast"  # begins the names of the windows of messages
POSE_PAYLOAD = "pose of the library"  # what is dragged from there to the timeline
TIP_ROOM = (28.0, 8.0)  # em: width and height that hardly any tooltip exceeds


def heading(look: Look, text: str, *, framed: bool = False) -> None:
    """Begin a group of settings; `framed` where a button follows on the line."""
    if imgui.get_cursor_pos_y() > imgui.get_cursor_start_pos().y:
        imgui.dummy((0, 0.3 * look.em))
    if framed:
        imgui.align_text_to_frame_padding()
    imgui.push_font(look.bold, 0)
    imgui.text(text)
    imgui.pop_font()


def small(look: Look, text: str) -> None:
    """Write a remark, smaller and dimmer than the text, wrapped to the panel."""
    imgui.push_font(None, SMALL * imgui.get_style().font_size_base)
    imgui.push_style_color(imgui.Col_.text, look.palette.dim)
    imgui.push_text_wrap_pos(0.0)
    imgui.text_unformatted(text)
    imgui.pop_text_wrap_pos()
    imgui.pop_style_color()
    imgui.pop_font()


def label(look: Look, text: str) -> None:
    """Name the field that follows on the same line, which takes the rest of its width."""
    imgui.align_text_to_frame_padding()
    imgui.push_style_color(imgui.Col_.text, look.palette.dim)
    imgui.text_unformatted(text)
    imgui.pop_style_color()
    imgui.same_line(LABEL_WIDTH * look.em)
    imgui.set_next_item_width(FILL)


def at_end(width: float) -> None:
    """Go on at the end of the line, where `width` pixels are left."""
    imgui.same_line()
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x - width)


def begin_tip() -> bool:
    """Begin a tooltip where the pointer rests on the last item; it covers no message.

    Returns
    -------
    bool
        Whether it shows; then it is to be ended by `imgui.end_tooltip`.
    """
    if not imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        return False
    mouse, em = imgui.get_mouse_pos(), imgui.get_font_size()
    room = TIP_ROOM[0] * em, TIP_ROOM[1] * em
    for window in imgui.get_current_context().windows:
        if not window.was_active or not window.name.startswith(TOAST):
            continue
        if mouse.x + room[0] > window.pos.x and mouse.y + room[1] > window.pos.y:
            # Messages are in the lower right corner: up and to the left there is none.
            corner = ImVec2(mouse.x - 0.4 * em, mouse.y - 0.4 * em)
            imgui.set_next_window_pos(corner, imgui.Cond_.always, (1, 1))
    return imgui.begin_tooltip()


def tip(text: str, keys: str = "") -> None:
    """Explain the last item where the pointer rests on it, and name its keys."""
    if begin_tip():
        imgui.text_unformatted(text)
        if keys:
            imgui.same_line()
            imgui.text_disabled(keys)
        imgui.end_tooltip()


def icon_button(
    look: Look,
    icon: str,
    name: str,
    hint: str,
    *,
    keys: str = "",
    active: bool = False,
    enabled: bool = True,
) -> bool:
    """Draw a square button with an icon; return whether it was pressed.

    Parameters
    ----------
    icon, name : str
        What it shows, and its id.
    hint, keys : str
        Of its tooltip.
    active : bool
        Whether what it switches is on.
    enabled : bool
    """
    palette = look.palette
    imgui.begin_disabled(not enabled)
    imgui.push_style_color(imgui.Col_.button, (0, 0, 0, 0))
    imgui.push_style_color(imgui.Col_.text, palette.accent if active else palette.text)
    size = imgui.get_frame_height()
    pressed = imgui.button(f"{icon}###{name}", (size * 1.15, size))
    imgui.pop_style_color(2)
    imgui.end_disabled()
    tip(hint, keys)
    return pressed


def main_button(look: Look, text: str, width: float = 0.0, *, enabled: bool = True) -> bool:
    """Draw the button of a panel's main purpose, in the accent colour."""
    palette = look.palette
    imgui.begin_disabled(not enabled)
    for slot in (imgui.Col_.button, imgui.Col_.button_hovered, imgui.Col_.button_active):
        imgui.push_style_color(slot, palette.accent)
    imgui.push_style_color(imgui.Col_.text, palette.on_accent)
    pressed = imgui.button(text, (width, 0))
    imgui.pop_style_color(4)
    imgui.end_disabled()
    return pressed


def choice(name: str, options: Sequence[str], current: str) -> str | None:
    """Draw a list to choose from; return what was newly chosen."""
    chosen = None
    if imgui.begin_combo(name, current):
        for option in options:
            if imgui.selectable(option, option == current)[0] and option != current:
                chosen = option
        imgui.end_combo()
    return chosen


def segments(
    look: Look,
    name: str,
    options: Sequence[tuple[str, str]],
    current: str,
    *,
    room: float = 0.0,
) -> str | None:
    """Draw alternatives side by side; return the one that was newly chosen.

    Parameters
    ----------
    name : str
        Its id.
    options : sequence of (value, text)
    current : str
        The value that is chosen now.
    room : float
        Pixels to leave free at the end of the line.
    """
    chosen = None
    palette = look.palette
    spacing = imgui.get_style().item_spacing.y
    width = imgui.get_content_region_avail().x - room
    imgui.push_id(name)
    imgui.push_style_var(imgui.StyleVar_.item_spacing, (0.12 * look.em, spacing))
    each = (width - 0.12 * look.em * (len(options) - 1)) / len(options)
    for index, (value, text) in enumerate(options):
        if index:
            imgui.same_line()
        is_current = value == current
        imgui.push_style_color(imgui.Col_.button, palette.pressed if is_current else palette.raised)
        imgui.push_style_color(imgui.Col_.text, palette.text if is_current else palette.dim)
        if imgui.button(f"{text}###{value}", (each, 0)) and not is_current:
            chosen = value
        imgui.pop_style_color(2)
    imgui.pop_style_var()
    imgui.pop_id()
    return chosen


def show_picture(
    texture: int, size: tuple[int, int], corner: ImVec2, room: ImVec2, *, opacity: float = 1.0
) -> None:
    """Draw a texture of so many pixels as large as there is room for it, in the middle."""
    scale = min(room.x / size[0], room.y / size[1])
    width, height = scale * size[0], scale * size[1]
    x = corner.x + (room.x - width) / 2
    y = corner.y + (room.y - height) / 2
    imgui.get_window_draw_list().add_image(
        imgui.ImTextureRef(texture),
        (x, y),
        (x + width, y + height),
        col=imgui.IM_COL32(255, 255, 255, round(255 * opacity)),
    )


def shortened(text: str, width: float) -> str:
    """Return a text as far as it fits into `width` pixels, with an ellipsis where it does not."""
    if imgui.calc_text_size(text).x <= width:
        return text
    fits, too_long = 0, len(text)
    while too_long - fits > 1:
        middle = (fits + too_long) // 2
        if imgui.calc_text_size(f"{text[:middle]}…").x <= width:
            fits = middle
        else:
            too_long = middle
    return f"{text[:fits].rstrip()}…"
