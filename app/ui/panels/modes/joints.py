"""The bar of joints, while a motion preset is set up."""

from imgui_bundle import imgui

from app.editor import Action, Project, Session, do
from app.editor.actions.posing.motion_presets import apply_motion, joint_placement, preset_setup
from app.editor.tools import move_tool
from app.editor.work.motion_setup import MotionSetup
from app.texts import _
from app.ui.shortcuts.keys import shown_keys
from app.ui.shortcuts.widgets import draw_action_button
from app.ui.style.theme import Look
from app.ui.style.widgets import main_button, text_button


def draw_joint_bar(
    session: Session, look: Look, project: Project, draft: MotionSetup
) -> list[Action]:
    """Draw what can be done with all joints, and the buttons that apply the motion or leave."""
    actions: list[Action] = []
    imgui.align_text_to_frame_padding()
    imgui.text_unformatted(_("Drag joints into place"))
    specs = (joint_placement.mirror_joints, joint_placement.reset_joints)
    for spec in specs if draft.body_kind.parents else ():
        imgui.same_line()
        actions += draw_action_button(session, look, spec)
    imgui.same_line()
    reason = preset_setup.apply_motion_disabled_reason(session, project)
    text = _("Apply {motion}").format(motion=draft.preset.label)
    if main_button(look, f"{text}###apply", reason=reason):
        actions.append(do(apply_motion.apply_motion_preset))
    imgui.same_line()
    keys = shown_keys(move_tool.return_to_posing)
    if text_button(_("Cancel") + "###leave", 0.0, _("Keep the joints for later"), keys):
        actions.append(do(preset_setup.close_motion_setup))
    return actions
