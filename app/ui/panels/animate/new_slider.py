"""The popup in which the poses of a new slider are chosen."""

from math import isqrt

from imgui_bundle import imgui

from app.editor import Action, Project, do
from app.editor.poses import sliders
from app.texts import _
from app.ui.style.widgets import text_button

NEW_SLIDER = "poses of a slider"  # id of the popup


def draw_new_slider(project: Project) -> list[Action]:
    """Draw the popup in which the poses of a new slider are chosen."""
    if not imgui.begin_popup(NEW_SLIDER):
        return []
    actions: list[Action] = []
    chosen: list[str | None] = []
    imgui.text_unformatted(_("Poses of the new slider"))
    names = (None, *(kept.name for kept in project.layer.library))
    for name in names:
        text = _("Undeformed drawing") if name is None else name
        is_on = name in project.pose_edits.slider_poses
        if imgui.checkbox(f"{text}###pose {name}", is_on)[0]:
            actions.append(do(sliders.toggle_slider_pose, name))
        chosen += [name] if is_on else []
    if len(chosen) == 3 and chosen[0] is None:
        # The drawing is between both poses, at 0.
        chosen = [chosen[1], None, chosen[2]]
    reason = None if len(chosen) > 1 else _("Choose at least two poses.")
    if text_button(_("Add slider"), reason=reason):
        actions.append(do(sliders.add_slider, tuple(chosen)))
        imgui.close_current_popup()
    imgui.same_line()
    is_square = len(chosen) > 3 and isqrt(len(chosen)) ** 2 == len(chosen)
    reason = None if is_square else _("A pad needs 4, 9, 16 or 25 poses, row by row.")
    if text_button(_("Add pad"), reason=reason):
        actions.append(do(sliders.add_slider, tuple(chosen), is_pad=True))
        imgui.close_current_popup()
    imgui.same_line()
    hint = _("From the undeformed drawing to the pose that the viewport shows")
    if text_button(_("Use shown pose"), hint=hint):
        actions.append(do(sliders.begin_slider))
        imgui.close_current_popup()
    imgui.end_popup()
    return actions
