"""Messages above the timeline, at the left: one at a time."""

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.editor import Action, Session, Toast, do
from app.editor.actions.dialog_actions import dismiss_toast
from app.texts import _, ngettext
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import TOAST, small_text

SECONDS = {"info": 5.0, "good": 8.0, "error": 15.0}
FADE = 0.25  # seconds
WIDTH, HEIGHT = 24.0, 8.0  # em: of a message, its height roughly
ICONS = {
    "info": icons.ICON_FA_CIRCLE_INFO,
    "good": icons.ICON_FA_CIRCLE_CHECK,
    "error": icons.ICON_FA_TRIANGLE_EXCLAMATION,
}


class ToastStack:
    """Draws the newest message. Its time stands still under the pointer or behind a dialog."""

    def __init__(self) -> None:
        self._since: dict[Toast, float] = {}  # when a message came to the front, in clock seconds
        self._at = 0.0  # the clock at the last frame
        self._buttons: list[imgui.internal.ImRect] = []  # of the message in the last frame

    def draw(self, session: Session, look: Look) -> list[Action]:
        """Draw the newest message. Return actions that dismiss the expired ones.

        Errors and messages with a button wait behind newer ones, and then have their whole time.
        """
        toasts, now = session.notices.toasts, session.clock()
        passed, self._at = now - self._at, now
        if not toasts:
            self._since.clear()
            self._buttons.clear()
            return []
        front = toasts[-1]
        since = self._since.get(front, now)
        if session.dialogs.current is not None and front in self._since:
            since += passed
        is_on_button = any(each.contains(imgui.get_mouse_pos()) for each in self._buttons)
        self._buttons.clear()
        # Clicks beside its buttons go to the drawing behind it.
        flags = _FLAGS if is_on_button else _FLAGS | imgui.WindowFlags_.no_mouse_inputs
        imgui.push_style_var(imgui.StyleVar_.alpha, _opacity(now - since))
        _place_toast(session, look, front, flags)
        actions = _contents(front, look, self._buttons, others=len(toasts) - 1)
        low = imgui.get_window_pos()
        is_hovered = imgui.is_mouse_hovering_rect(low, low + imgui.get_window_size(), clip=False)
        _stripe(front, look)
        imgui.end()
        imgui.pop_style_var()
        if is_hovered:
            since = max(since, now - FADE)
        self._since = {front: since}
        if now - since > SECONDS[front.tone]:
            actions.append(do(dismiss_toast, front))
        for toast in toasts[:-1]:
            waits = toast.tone == "error" or toast.action is not None
            if not waits and now - toast.born > SECONDS[toast.tone]:
                actions.append(do(dismiss_toast, toast))
        return actions


def _opacity(age: float) -> float:
    """Return the opacity of a message that fades in."""
    return max(0.15, min(1.0, age / FADE + 0.15))


def _place_toast(session: Session, look: Look, toast: Toast, flags: int) -> None:
    """Begin the window of a message at its place."""
    window = imgui.get_main_viewport()
    gap = 0.8 * look.em
    drawing = imgui.internal.find_window_by_name("###Viewport")
    if session.dialogs.current is not None:
        # A dialog is in the middle, with its buttons at its lower edge.
        imgui.set_next_window_pos(window.work_pos + ImVec2(gap, gap))
    elif session.project is not None and drawing is not None:
        low, size = drawing.pos + ImVec2(gap, gap), drawing.size - ImVec2(gap, gap) * 2
        # Above the timeline, or above the drawing if the guide's card is there.
        is_low = not _is_guide_near(low + ImVec2(0, size.y), look)
        corner, pivot = low + ImVec2(0, size.y * is_low), ImVec2(0, float(is_low))
        imgui.set_next_window_pos(corner, imgui.Cond_.always, pivot)
    else:
        height = window.work_size.y - imgui.get_frame_height() - 2 * gap
        corner = window.work_pos + ImVec2(gap, height)
        imgui.set_next_window_pos(corner, imgui.Cond_.always, ImVec2(0, 1))
    imgui.set_next_window_size(ImVec2(WIDTH * look.em, 0))
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 1.0)
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.5 * look.em)
    imgui.push_style_color(imgui.Col_.window_bg, look.palette.raised)
    imgui.begin(f"{TOAST}{toast.place}", flags=flags)
    imgui.internal.bring_window_to_display_front(imgui.internal.get_current_window())
    imgui.pop_style_color()
    imgui.pop_style_var(2)


def _is_guide_near(corner: ImVec2, look: Look) -> bool:
    """Return whether the guide's card is where a message at a lower left corner would be."""
    card = imgui.internal.find_window_by_name("###guide")
    if card is None or not card.was_active:
        return False
    is_beside = card.pos.x < corner.x + WIDTH * look.em
    return is_beside and card.pos.y + card.size.y > corner.y - HEIGHT * look.em


_FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_focus_on_appearing
    | imgui.WindowFlags_.no_nav
    | imgui.WindowFlags_.no_move
)


def _contents(
    toast: Toast, look: Look, buttons: list[imgui.internal.ImRect], *, others: int
) -> list[Action]:
    """Draw a message and the number of others; note its buttons' places. Return its actions."""
    actions = []

    def note(*, is_pressed: bool) -> bool:
        buttons.append(imgui.internal.ImRect(imgui.get_item_rect_min(), imgui.get_item_rect_max()))
        return is_pressed

    imgui.text_colored(_colour(toast, look), ICONS[toast.tone])
    imgui.same_line()
    imgui.begin_group()
    imgui.push_text_wrap_pos(imgui.get_window_width() - 2.6 * look.em)
    imgui.text_unformatted(toast.text)
    imgui.pop_text_wrap_pos()
    details = f"{_('Details')}##{toast.born}"  # other messages may have a popup open
    flags = imgui.TreeNodeFlags_.no_tree_push_on_open
    if toast.details and note(is_pressed=imgui.tree_node_ex(details, flags)):
        small_text(look, toast.details.strip()[-1500:])
    if toast.details and note(is_pressed=imgui.small_button(_("Copy"))):
        imgui.set_clipboard_text(f"{toast.text}\n\n{toast.details}")
    if toast.action is not None:
        if toast.details:
            imgui.same_line()
        imgui.push_style_color(imgui.Col_.button, look.palette.pressed)
        if note(is_pressed=imgui.small_button(toast.label)):
            actions += [toast.action, do(dismiss_toast, toast)]
        imgui.pop_style_color()
    if others:
        text = ngettext("{count} more message", "{count} more messages", others)
        small_text(look, text.format(count=others))
    imgui.end_group()
    imgui.set_cursor_pos(ImVec2(imgui.get_window_width() - 2.1 * look.em, 0.35 * look.em))
    imgui.push_style_color(imgui.Col_.button, (0, 0, 0, 0))
    if note(is_pressed=imgui.small_button(f"{icons.ICON_FA_XMARK}###dismiss")):
        actions.append(do(dismiss_toast, toast))
    imgui.pop_style_color()
    return actions


def _stripe(toast: Toast, look: Look) -> None:
    corner, size = imgui.get_window_pos(), imgui.get_window_size()
    imgui.get_window_draw_list().add_rect_filled(
        corner,
        ImVec2(corner.x + 0.22 * look.em, corner.y + size.y),
        colour_u32(_colour(toast, look)),
        0.22 * look.em,
    )


def _colour(toast: Toast, look: Look) -> imgui.ImVec4:
    palette = look.palette
    return {"info": palette.accent, "good": palette.good, "error": palette.danger}[toast.tone]
