"""Messages in the lower right corner. They disappear unless the pointer is on them."""

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.editor import Action, Session, Toast, do
from app.editor.actions.dialog_actions import dismiss_toast
from app.texts import _
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import TOAST, small_text

SECONDS = {"info": 5.0, "good": 8.0, "error": 15.0}
FADE = 0.25  # seconds
WIDTH = 24.0  # em
MOST = 5
ICONS = {
    "info": icons.ICON_FA_CIRCLE_INFO,
    "good": icons.ICON_FA_CIRCLE_CHECK,
    "error": icons.ICON_FA_TRIANGLE_EXCLAMATION,
}


def draw_toasts(session: Session, look: Look) -> list[Action]:
    """Draw the newest messages. Return actions that dismiss the expired ones."""
    actions: list[Action] = []
    viewport = imgui.get_main_viewport()
    gap = 1.0 * look.em
    right = viewport.work_pos.x + viewport.work_size.x - gap
    status_bar = imgui.get_frame_height() + look.em
    bottom = viewport.work_pos.y + viewport.work_size.y - status_bar - 0.5 * gap
    now = session.clock()
    for toast in reversed(session.notices.toasts[-MOST:]):
        age = now - toast.born
        left = SECONDS[toast.tone] - age
        imgui.set_next_window_pos(ImVec2(right, bottom), imgui.Cond_.always, ImVec2(1, 1))
        imgui.set_next_window_size(ImVec2(WIDTH * look.em, 0))
        imgui.push_style_var(imgui.StyleVar_.alpha, max(0.15, min(1.0, age / FADE + 0.15)))
        imgui.push_style_var(imgui.StyleVar_.window_border_size, 1.0)
        imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.5 * look.em)
        imgui.push_style_color(imgui.Col_.window_bg, look.palette.raised)
        imgui.begin(f"{TOAST}{toast.place}", flags=_FLAGS)
        imgui.internal.bring_window_to_display_front(imgui.internal.get_current_window())
        actions += _contents(toast, look)
        hovered = imgui.is_window_hovered(imgui.HoveredFlags_.root_and_child_windows)
        bottom -= imgui.get_window_height() + 0.5 * gap
        _stripe(toast, look)
        imgui.end()
        imgui.pop_style_color()
        imgui.pop_style_var(3)
        if left < 0 and not hovered:
            actions.append(do(dismiss_toast, toast))
    return actions


_FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_focus_on_appearing
    | imgui.WindowFlags_.no_nav
    | imgui.WindowFlags_.no_move
)


def _contents(toast: Toast, look: Look) -> list[Action]:
    actions = []
    imgui.text_colored(_colour(toast, look), ICONS[toast.tone])
    imgui.same_line()
    imgui.begin_group()
    imgui.push_text_wrap_pos(imgui.get_window_width() - 2.6 * look.em)
    imgui.text_unformatted(toast.text)
    imgui.pop_text_wrap_pos()
    details = f"{_('Details')}##{toast.born}"  # other messages may have a popup open
    if toast.details and imgui.tree_node_ex(details, imgui.TreeNodeFlags_.no_tree_push_on_open):
        small_text(look, toast.details.strip()[-1500:])
    if toast.details and imgui.small_button(_("Copy")):
        imgui.set_clipboard_text(f"{toast.text}\n\n{toast.details}")
    if toast.action is not None:
        if toast.details:
            imgui.same_line()
        if imgui.small_button(toast.label):
            actions.append(toast.action)
    imgui.end_group()
    imgui.set_cursor_pos(ImVec2(imgui.get_window_width() - 2.1 * look.em, 0.35 * look.em))
    imgui.push_style_color(imgui.Col_.button, (0, 0, 0, 0))
    if imgui.small_button(f"{icons.ICON_FA_XMARK}###dismiss"):
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
