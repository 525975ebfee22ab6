"""The bar of icon buttons at the left."""

from imgui_bundle import ImVec2, imgui

from app.editor import Action, Project, Session
from app.editor.actions import viewing
from app.editor.tools import move_tool
from app.ui.shortcuts.widgets import draw_action_button
from app.ui.style.theme import Look

# A gap separates two groups.
GROUPS = (
    (viewing.zoom_to_pose, move_tool.toggle_move_tool),
    (
        *(viewing.HANDLES, viewing.WIREFRAME, viewing.OUTLINE, viewing.toggle_heat_map),
        *(viewing.toggle_comparison, viewing.ONION_SKIN, viewing.MOTION_PATHS),
    ),
    (viewing.toggle_auto_key,),
)


def draw_icon_bar(session: Session, look: Look, _: Project) -> list[Action]:
    actions: list[Action] = []
    for number, group in enumerate(GROUPS):
        if number:
            imgui.dummy(ImVec2(0, 0.4 * look.em))
        for spec in group:
            actions += draw_action_button(session, look, spec)
    return actions
