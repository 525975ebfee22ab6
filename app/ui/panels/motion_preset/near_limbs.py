"""Questions about near and far limbs of a draft, where the drawing does not show them."""

from itertools import pairwise

import numpy as np
from imgui_bundle import ImVec2, imgui

from app.editor import Action, do
from app.editor.actions.posing.motion_presets import joint_placement
from app.editor.tools.edit_tools.joint_tools import joint_role
from app.editor.work.motion_setup import MotionSetup
from app.rigging import other_side, without_side
from app.texts import _
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import small_text, split_line, text_button
from app.ui.viewport.interaction.shapes import role_colour

PICTURE_HEIGHT = 5.0  # em


def _draw_limb(look: Look, draft: MotionSetup, end: str, size: ImVec2) -> None:
    """Draw the outline of the drawing and one limb in it."""
    outline, low = draft.domain.outline, imgui.get_cursor_screen_pos()
    across, tall = float(np.ptp(outline.real)), float(np.ptp(outline.imag))
    scale = min(size.x / across, size.y / tall)
    left = low.x + (size.x - scale * across) / 2
    top = low.y + (size.y - scale * tall) / 2

    def on_panel(place: complex) -> ImVec2:
        beside, below = place.real - outline.real.min(), outline.imag.max() - place.imag
        return ImVec2(left + scale * float(beside), top + scale * float(below))

    draw_list = imgui.get_window_draw_list()
    points = [on_panel(place) for place in outline.tolist()]
    draw_list.add_polyline(
        list(points), colour_u32(look.palette.dim), 0.08 * look.em, imgui.ImDrawFlags_.closed
    )
    body = draft.body_kind
    limb = [end]
    while limb[-1] and without_side(limb[-1]) not in {"hip", "shoulder"}:
        limb.append(body.parent(limb[-1], draft.joints))
    colour = colour_u32(role_colour(look, joint_role(end)))
    for one, other in pairwise(name for name in limb if name):
        ends = on_panel(draft.joints[one]), on_panel(draft.joints[other])
        draw_list.add_line(*ends, colour, 0.25 * look.em)
    imgui.dummy(size)


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
        width = (imgui.get_content_region_avail().x - imgui.get_style().item_spacing.x) / 2
        for number, name in enumerate((end, other_side(end))):
            if number:
                imgui.same_line()
            _draw_limb(look, draft, name, ImVec2(width, PICTURE_HEIGHT * look.em))
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
