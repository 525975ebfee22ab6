"""The tab of motion: poses and sliders, motion presets, and sounds."""

from imgui_bundle import imgui

from app.editor import Action, Project, Session
from app.texts import _
from app.ui.panels.animate.poses import draw_flip, draw_poses
from app.ui.panels.animate.sliders import Pictures, draw_sliders
from app.ui.panels.motion_preset.tab import draw_motion_panel
from app.ui.panels.sound.tab import draw_sound_panel
from app.ui.style.theme import Look

_FOLD = imgui.TreeNodeFlags_.no_tree_push_on_open | imgui.TreeNodeFlags_.frame_padding


def draw_animate_panel(
    session: Session, look: Look, project: Project, pictures: Pictures
) -> list[Action]:
    """Draw all that moves a layer. While a motion preset is set up, draw only its settings."""
    if project.layer_runtime.shown is None:
        return []
    if session.tools.motion_setup is not None or project.motion_job is not None:
        return draw_motion_panel(session, look, project)
    actions = draw_poses(session, look, project, pictures)
    if imgui.tree_node_ex(f"{_('Flip')}###flip", _FOLD):
        actions += draw_flip(session, look, project)
    actions += draw_sliders(session, look, project, pictures)
    actions += draw_motion_panel(session, look, project)
    return actions + draw_sound_panel(session, look, project)
