"""The bar of the active mode at the top of the drawing, and its settings beside the drawing."""

from imgui_bundle import ImVec2, imgui

from app.editor import Action, Session
from app.ui.panels.modes.cut_out import draw_cut_out_bar, draw_cut_out_settings
from app.ui.panels.modes.joints import draw_joint_bar
from app.ui.style.theme import Look

MARGIN, SETTINGS = 0.6, 20.0  # em: around the bar, width of the settings
FIXED = (
    imgui.WindowFlags_.no_title_bar
    | imgui.WindowFlags_.no_resize
    | imgui.WindowFlags_.no_collapse
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_focus_on_appearing
    | imgui.WindowFlags_.no_nav
    | imgui.WindowFlags_.no_move
)
FITTED = FIXED | imgui.WindowFlags_.always_auto_resize


def draw_mode_bar(session: Session, look: Look) -> list[Action]:
    """Draw the bar while the cut-out is edited, or joints are placed."""
    project, draft = session.project, session.tools.motion_setup
    viewport = imgui.internal.find_window_by_name("###Viewport")
    if project is None or viewport is None or not (draft or session.tools.is_cutting):
        return []
    margin = MARGIN * look.em
    corner, room = viewport.pos + ImVec2(margin, margin), viewport.size - ImVec2(margin, margin) * 2
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 1.0)
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.6 * look.em)
    imgui.push_style_var(imgui.StyleVar_.window_padding, ImVec2(0.5 * look.em, 0.4 * look.em))
    imgui.push_style_color(imgui.Col_.window_bg, look.palette.panel)
    top = corner + ImVec2(room.x / 2, 0)
    imgui.set_next_window_pos(top, imgui.Cond_.always, ImVec2(0.5, 0))
    imgui.set_next_window_size_constraints(ImVec2(0, 0), room)
    imgui.begin("###mode", flags=FITTED)
    if draft is not None:
        actions, has_settings = draw_joint_bar(session, look, project, draft), False
    else:
        actions, has_settings = draw_cut_out_bar(session, look, project, room.x)
    below = imgui.get_window_pos().y + imgui.get_window_height() + margin
    imgui.end()
    if has_settings:
        width = min(SETTINGS * look.em, room.x)
        height = max(corner.y + room.y - below, look.em)
        imgui.set_next_window_pos(ImVec2(corner.x, below))
        imgui.set_next_window_size_constraints(ImVec2(width, 0), ImVec2(width, height))
        imgui.begin("###mode settings", flags=FITTED)
        actions += draw_cut_out_settings(session, look, project)
        imgui.end()
    imgui.pop_style_color()
    imgui.pop_style_var(3)
    return actions
