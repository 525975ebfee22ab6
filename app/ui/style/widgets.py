"""The widgets that all panels share."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager

from imgui_bundle import ImVec2, ImVec4, imgui, imgui_ctx

from app.texts import _
from app.ui.style.theme import SMALL, Look

LABEL_WIDTH, NAME_WIDTH, TIGHT = 5.6, 14.0, 0.15  # em; the last: padding in fixed widths
FILL = -imgui.FLT_MIN  # as a width: the rest of the line
TOAST = "##toast"  # prefix of the windows of toasts
POSE_PAYLOAD = "pose of the library"  # drag-and-drop type of a library pose
TIP_ROOM = (28.0, 8.0)  # em: width and height of nearly all tooltips


def push_text_size(size: float, font: imgui.ImFont | None = None) -> AbstractContextManager[object]:
    """Write in another font size, relative to the text's, and optionally in another font."""
    return imgui_ctx.push_font(font, size * imgui.get_style().font_size_base)


def bold_text(look: Look, text: str) -> None:
    with imgui_ctx.push_font(look.bold, 0):
        imgui.text(text)


def heading(look: Look, text: str, *, framed: bool = False) -> None:
    """Begin a group of settings; `framed` if a button follows on the same line."""
    if imgui.get_cursor_pos_y() > imgui.get_cursor_start_pos().y:
        imgui.dummy(ImVec2(0, 0.3 * look.em))
    if framed:
        imgui.align_text_to_frame_padding()
    bold_text(look, text)


def small_text(look: Look, text: str, colour: ImVec4 | None = None) -> None:
    """Write a note, smaller than the text, wrapped to the panel, by default dimmer."""
    with push_text_size(SMALL), imgui_ctx.push_text_wrap_pos(0.0):
        imgui.text_colored(colour or look.palette.dim, text)


def label(look: Look, text: str) -> None:
    """Label the next field on the same line, which takes the rest of the width."""
    imgui.align_text_to_frame_padding()
    end = imgui.get_cursor_pos_x() + imgui.calc_text_size(text).x
    imgui.text_colored(look.palette.dim, text)
    imgui.same_line(max(LABEL_WIDTH * look.em, end + 0.4 * look.em))
    imgui.set_next_item_width(FILL)


def align_right(width: float) -> None:
    """Move to the end of the line, so that `width` pixels are left."""
    imgui.same_line()
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x - width)


def begin_tooltip() -> bool:
    """Begin a tooltip if the pointer rests on the last item. It covers no toast.

    Returns
    -------
    bool
        Whether the tooltip is visible; then the caller must call `imgui.end_tooltip`.
    """
    if not imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip):
        return False
    mouse, em = imgui.get_mouse_pos(), imgui.get_font_size()
    room = TIP_ROOM[0] * em, TIP_ROOM[1] * em
    for window in imgui.get_current_context().windows:
        if not window.was_active or not window.name.startswith(TOAST):
            continue
        low, high = window.pos, window.pos + window.size
        is_beside = mouse.x < high.x and mouse.x + room[0] > low.x
        if is_beside and mouse.y < high.y and mouse.y + room[1] > low.y:
            # Toasts are above the timeline, so there is room above them.
            corner = ImVec2(mouse.x, min(mouse.y, low.y) - 0.4 * em)
            imgui.set_next_window_pos(corner, imgui.Cond_.always, ImVec2(0, 1))
    return imgui.begin_tooltip()


def draw_tooltip(text: str, keys: str = "") -> None:
    """Show a text and its shortcut if the pointer rests on the last item. "" shows nothing."""
    if text and begin_tooltip():
        room = TIP_ROOM[0] * imgui.get_font_size()
        imgui.push_text_wrap_pos(room)
        imgui.text_unformatted(text)
        if keys:
            if imgui.calc_text_size(f"{text}  {keys}").x < room:
                imgui.same_line()
            imgui.text_disabled(keys)
        imgui.pop_text_wrap_pos()
        imgui.end_tooltip()


def icon_button(
    look: Look,
    icon: str,
    name: str,
    hint: str,
    *,
    keys: str = "",
    active: bool = False,
    reason: str | None = None,
) -> bool:
    """Draw a square button with an icon. Return whether it was pressed.

    Parameters
    ----------
    name : str
        Its id.
    keys : str
        Shortcut in the tooltip.
    active : bool
        Whether the option that the button switches is on.
    reason : str, optional
        The reason why the button is disabled, in place of the hint.
    """
    palette = look.palette
    imgui.begin_disabled(reason is not None)
    imgui.push_style_color(imgui.Col_.button, (0, 0, 0, 0))
    imgui.push_style_color(imgui.Col_.text, palette.accent if active else palette.text)
    size = imgui.get_frame_height()
    pressed = imgui.button(f"{icon}###{name}", ImVec2(size * 1.15, size))
    imgui.pop_style_color(2)
    imgui.end_disabled()
    draw_tooltip(reason or hint, keys)
    return pressed


def main_button(
    look: Look,
    text: str,
    width: float = 0.0,
    hint: str = "",
    keys: str = "",
    *,
    reason: str | None = None,
) -> bool:
    """Draw the main button of a panel, in the accent colour."""
    palette = look.palette
    for slot in (imgui.Col_.button, imgui.Col_.button_hovered, imgui.Col_.button_active):
        imgui.push_style_color(slot, palette.accent)
    imgui.push_style_color(imgui.Col_.text, palette.on_accent)
    imgui.begin_disabled(reason is not None)
    pressed = imgui.button(text, ImVec2(width, 0))
    imgui.end_disabled()
    imgui.pop_style_color(4)
    draw_tooltip(reason or hint, keys)
    return pressed


def text_button(
    text: str, width: float = 0.0, hint: str = "", keys: str = "", *, reason: str | None = None
) -> bool:
    """Draw a button with its tooltip: a hint, or the reason why the button is disabled."""
    imgui.begin_disabled(reason is not None)
    pressed = fitted_button(text, width)
    imgui.end_disabled()
    draw_tooltip(reason or hint, keys)
    return pressed


def fitted_button(text: str, width: float) -> bool:
    """Draw a button. If its width is given, its text may come close to the edges."""
    style = imgui.get_style().frame_padding
    padding = ImVec2(TIGHT * imgui.get_font_size() if width else style.x, style.y)
    with imgui_ctx.push_style_var(imgui.StyleVar_.frame_padding, padding):
        return imgui.button(text, ImVec2(width, 0))


def menu_entry(text: str, icon: str = "", keys: str = "", *, reason: str | None = None) -> bool:
    """Draw an entry of a menu, with the reason why it is disabled in its tooltip."""
    chosen = imgui.internal.menu_item_ex(text, icon, keys, enabled=reason is None)
    draw_tooltip(reason or "")
    return chosen


def split_line(
    count: int, gap: float | None = None, *, room: float = 0.0, widest: float = 0.0
) -> Iterator[float]:
    """Lay items side by side over the rest of the line: yield each item's width before it.

    Parameters
    ----------
    gap : float, optional
        Pixels between two items; by default the style's spacing.
    room : float
        Pixels to leave free at the end of the line.
    widest : float
        Pixels that an item needs. Where they do not all fit, they take several lines.
    """
    gap = imgui.get_style().item_spacing.x if gap is None else gap
    left, available = imgui.get_cursor_pos_x(), imgui.get_content_region_avail().x - room
    fitting = int((available + gap) // (widest + gap)) if widest else count
    # Lines of equal length: four items of which three would fit become two and two.
    columns = -(-count // -(-count // min(max(fitting, 1), count)))
    width = (available - gap * (columns - 1)) / columns
    for index in range(count):
        imgui.same_line(0, gap) if index % columns else imgui.set_cursor_pos_x(left)
        yield width


def progress_bar(share: float, text: str) -> bool:
    """Draw a progress bar with a cancel button. Return whether the button was pressed."""
    imgui.progress_bar(share, ImVec2(FILL, 0), text)
    return imgui.button(_("Cancel") + "###stop", ImVec2(FILL, 0))


def name_popup(
    look: Look, popup: str, name: str, taken: Iterable[str] = (), refusal: str = ""
) -> str | None:
    """Draw the rename field in its popup, if the popup is open. Return the entered name.

    Names in `taken` are refused by the message `refusal`.
    """
    if not imgui.begin_popup(popup):
        return None
    if imgui.is_window_appearing():
        imgui.set_keyboard_focus_here()
    imgui.set_next_item_width(NAME_WIDTH * look.em)
    flags = imgui.InputTextFlags_.auto_select_all | imgui.InputTextFlags_.enter_returns_true
    entered, name = imgui.input_text("##name", name, flags)
    draw_tooltip(_("Enter renames, Esc cancels"))
    name = name.strip()
    is_free = name not in taken
    if not is_free:
        small_text(look, refusal)
    elif entered:
        imgui.close_current_popup()
    imgui.end_popup()
    return name if entered and is_free and name else None


def colour_field(name: str, code: str, flags: int = 0) -> str | None:
    """Draw a field for a colour, "#rrggbb". Return the colour when a different one was chosen."""
    levels = [level / 255 for level in bytes.fromhex(code[1:])]
    changed, levels = imgui.color_edit3(f"##{name}", levels, flags)
    if not changed:
        return None
    return f"#{bytes(round(255 * min(max(level, 0.0), 1.0)) for level in levels[:3]).hex()}"


def option_buttons(
    look: Look,
    name: str,
    options: Sequence[tuple[str, str]],
    current: str,
    *,
    room: float = 0.0,
) -> str | None:
    """Draw alternatives side by side. Return the newly chosen value.

    Parameters
    ----------
    name : str
        Its id.
    options : sequence of (value, text)
    room : float
        Pixels to leave free at the end of the line.
    """
    chosen = None
    palette = look.palette
    imgui.push_id(name)
    widest = max(imgui.calc_text_size(text).x for _value, text in options)
    widest += 2 * TIGHT * imgui.get_font_size()
    widths = split_line(len(options), 0.12 * look.em, room=room, widest=widest)
    for (value, text), width in zip(options, widths, strict=True):
        is_current = value == current
        imgui.push_style_color(imgui.Col_.button, palette.pressed if is_current else palette.raised)
        imgui.push_style_color(imgui.Col_.text, palette.text if is_current else palette.dim)
        if fitted_button(f"{text}###{value}", width) and not is_current:
            chosen = value
        imgui.pop_style_color(2)
    imgui.pop_id()
    return chosen


def shorten_text(text: str, width: float) -> str:
    """Cut a text to `width` pixels, with an ellipsis if it is longer."""
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


def is_hovered_or_held() -> bool:
    """Return whether the last item is hovered or active."""
    return imgui.is_item_hovered() or imgui.is_item_active()


def is_pressed() -> bool:
    """Return whether the left mouse button was pressed on the last item in this frame."""
    return imgui.is_item_activated() and imgui.is_mouse_clicked(imgui.MouseButton_.left)
