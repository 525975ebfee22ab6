"""The bar of tools at the left, with the menu of what is shown over the drawing."""

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.editor import Action, Project, Session, do
from app.editor.actions import viewing
from app.editor.actions.layer_setup import stiffness_editing
from app.editor.actions.posing.motion_presets import preset_setup
from app.editor.tools import move_tool
from app.storage import LARGEST_GHOST_STEP, MOST_GHOSTS
from app.texts import _
from app.ui.shortcuts.keys import shown_keys
from app.ui.shortcuts.widgets import draw_action_button, draw_action_item
from app.ui.style.theme import Look
from app.ui.style.widgets import draw_tooltip, icon_button

POSE = "Pose"  # id of the tool that has no action of its own
TOOLS = (
    move_tool.toggle_move_tool,
    stiffness_editing.MAKE_STIFF,
    stiffness_editing.DRAW_BONES,
    preset_setup.begin_motion_setup,
)
# What the eye shows or hides, and how the drawing fits into the view.
SHOWN = (
    viewing.HANDLES,
    viewing.OUTLINE,
    viewing.MOTION_PATHS,
    viewing.MIRROR_AXIS,
    viewing.ONION_SKIN,
)
FITS = (viewing.zoom_to_pose, viewing.zoom_to_motion, viewing.FIT_PICTURE)


def draw_tool_bar(session: Session, look: Look, _project: Project) -> list[Action]:
    actions: list[Action] = []
    is_posing, keys = session.tools.is_posing, shown_keys(move_tool.return_to_posing)
    hint = _("Pose: click to add handles, drag them to pose")
    if icon_button(look, icons.ICON_FA_ARROW_POINTER, POSE, hint, keys=keys, active=is_posing):
        actions += [] if is_posing else [move_tool.return_to_posing.action]
    for spec in TOOLS:
        actions += draw_action_button(session, look, spec)
    imgui.dummy(ImVec2(0, 0.4 * look.em))
    if icon_button(look, icons.ICON_FA_EYE, "eye", _("What is shown over the drawing")):
        imgui.open_popup("menu of the eye")
    return actions + _eye_menu(session, look)


def _eye_menu(session: Session, look: Look) -> list[Action]:
    actions: list[Action] = []
    if not imgui.begin_popup("menu of the eye"):
        return actions
    for spec in SHOWN:
        actions += draw_action_item(session, spec)
    if imgui.begin_menu(_("Onion skin frames")):
        actions += _onion_skin(session, look)
        imgui.end_menu()
    imgui.separator()
    for spec in FITS:
        actions += draw_action_item(session, spec)
    imgui.end_popup()
    return actions


def _onion_skin(session: Session, look: Look) -> list[Action]:
    """Draw how many poses the onion skin shows, and where."""
    actions: list[Action] = []
    preferences = session.settings.preferences
    values = [preferences.ghosts_before, preferences.ghosts_after, preferences.ghost_step]
    before = list(values)
    sliders = (
        *((_("before"), 0, MOST_GHOSTS), (_("after"), 0, MOST_GHOSTS)),
        (_("frames apart"), 1, LARGEST_GHOST_STEP),
    )
    for index, (name, low, high) in enumerate(sliders):
        imgui.set_next_item_width(8 * look.em)
        values[index] = imgui.slider_int(name, values[index], low, high)[1]
    if values != before:
        actions.append(do(viewing.set_onion_skin, *values))
    changed, in_front = imgui.checkbox(_("Draw in front"), preferences.ghosts_in_front)
    draw_tooltip(_("Draw the onion skin in front of all layers, not behind the posed layers"))
    if changed:
        actions.append(do(viewing.set_onion_skin_in_front, in_front))
    return actions
