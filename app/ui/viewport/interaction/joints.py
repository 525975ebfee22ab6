"""The joints of a motion preset that is being set up, over the drawing."""

from imgui_bundle import ImVec2, ImVec4, imgui

from app.editor import Session
from app.editor.actions.posing.motion_presets import joint_placement
from app.editor.tools.edit_tools.joint_tools import find_joint_near
from app.ui.style.drawing import draw_knob, draw_tag, outline_strokes, tag_size
from app.ui.style.theme import Look, colour_u32
from app.ui.viewport.screen import ScreenMapping

DOT, LIMB = 0.42, 0.16  # em: radius of a joint, width of a bone


def draw_joints(session: Session, look: Look, screen: ScreenMapping) -> None:
    """Draw joints and bones, each side in its own colour, with the name of the pointed joint."""
    project = screen.project
    draft = project.motion_setup
    if draft is None or project.playhead.since is not None:
        return
    kind, places = draft.body_kind, joint_placement.shown_joint_places(project)
    points = {name: screen.point(at) for name, at in places.items()}
    draw_list = imgui.get_window_draw_list()
    for name, point in points.items():
        before = kind.parent(name, points)
        if before:
            for tone, width in outline_strokes(look, colour_u32(joint_colour(look, name)), LIMB):
                draw_list.add_line(points[before], point, tone, width)
    for name, point in points.items():
        draw_knob(look, point, DOT, joint_colour(look, name))
    hot = (
        draft.selected_joint
        if session.active_tool
        else find_joint_near(session, project, screen.pointer)
    )
    for marked in dict.fromkeys((draft.selected_joint, hot)):
        if marked in points:
            radius = 1.7 * DOT * look.em
            draw_list.add_circle(points[marked], radius, colour_u32(look.palette.text), 0, 1.5)
    if hot is not None and hot in points:
        low = points[hot] + ImVec2(0.8 * look.em, -0.8 * look.em - tag_size(look, hot).y)
        draw_tag(look, low, hot)


def joint_colour(look: Look, name: str) -> ImVec4:
    """Return the colour of a joint, which depends on its side."""
    palette = look.palette
    if name.endswith(".L"):
        return palette.good
    return palette.warning if name.endswith(".R") else palette.accent
