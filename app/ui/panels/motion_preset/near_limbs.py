"""Questions about near and far limbs of a draft, where the drawing does not show them."""

from imgui_bundle import imgui

from app.editor import Action, do
from app.editor.actions.posing.motion_presets import joint_placement
from app.editor.work.motion_setup import MotionSetup
from app.rigging import other_side
from app.texts import _
from app.ui.style.theme import Look
from app.ui.style.widgets import small_text, split_line, text_button


def draw_near_limb_questions(look: Look, draft: MotionSetup) -> list[Action]:
    """Ask which limb of a pair is nearer, where the drawing does not show it."""
    actions: list[Action] = []
    for end in draft.unsure:
        is_leg = end.startswith("foot")
        is_front = draft.kind == "four-legs" and not is_leg
        text = (
            _("Which leg is nearer?")
            if is_leg
            else _("Which front leg is nearer?")
            if is_front
            else _("Which arm is nearer?")
        )
        small_text(look, text, look.palette.warning)
        widths = split_line(2)
        for number, name in enumerate((end, other_side(end))):
            action = joint_placement.swap_near_limbs if number else joint_placement.keep_near_limbs
            at, other = draft.joints[name], draft.joints[other_side(name)]
            side = _("The left one") if at.real < other.real else _("The right one")
            if text_button(f"{side}###{end} {number}", next(widths), _("On the picture")):
                actions.append(do(action, end))
            if imgui.is_item_hovered() and draft.selected_joint != name:
                # The joint lights up on the drawing.
                actions.append(do(joint_placement.select_joint, name))
    return actions
