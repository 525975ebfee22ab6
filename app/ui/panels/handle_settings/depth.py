"""The depth of a handle: which part is painted in front where the drawing overlaps itself."""

from imgui_bundle import imgui

from app.document import DEFAULT_DEPTH_EXTENT, Handle, Layer, layer_commands, value_at
from app.editor import Action, Project, Session, do
from app.editor.actions import editing, playback, viewing
from app.editor.actions.layer_setup import handle_editing
from app.texts import _
from app.ui.panels.key_diamond import diamond_room, draw_key_diamond
from app.ui.style.sliders import Scale, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import heading, label
from engine.geometry import diameter

DEPTHS = Scale(left=-1.0, right=1.0)


def draw_depth_settings(
    session: Session, look: Look, project: Project, handle: Handle
) -> list[Action]:
    """Draw the depth of a handle, with the button that keys it, and its extent."""
    heading(look, _("In front"))
    imgui.begin_group()
    actions = _depth(session, look, project, handle) + _extent(look, project.layer, handle)
    imgui.end_group()
    # The drawing is tinted while the pointer is on these settings.
    is_pointed = imgui.is_item_hovered(imgui.HoveredFlags_.rect_only) and imgui.is_window_hovered(
        imgui.HoveredFlags_.allow_when_blocked_by_active_item
    )
    if is_pointed != (session.display.tint == "depth"):
        actions.append(do(viewing.set_tint, "depth" if is_pointed else None))
    return actions


def _depth(session: Session, look: Look, project: Project, handle: Handle) -> list[Action]:
    channel = handle_editing.depth_channel(project, handle)
    frame = playback.edited_frame(session, project)
    label(look, _("Depth"))
    hint = _("Order where the drawing overlaps itself: −1 paints this part behind, 1 in front")
    depth = value_at(project.document, channel, frame)
    entered = slider(look, "depth", depth, DEPTHS, text="%.2f", hint=hint, room=diamond_room(look))
    actions = draw_key_diamond(project.document, look, channel, frame)
    if entered is not None:
        value = round(min(max(entered.value, -1.0), 1.0), 2)
        actions.append(do(handle_editing.set_depth, handle.id, value))
    return actions


def _extent(look: Look, layer: Layer, handle: Handle) -> list[Action]:
    label(look, _("Extent"))
    usual = DEFAULT_DEPTH_EXTENT * diameter(layer.domain.outline)
    extents = Scale(left=0.1 * usual, right=8 * usual, logarithmic=True)
    hint = _("How far the depth reaches around the handle, in pixels along the drawing")
    entered = slider(look, "extent", handle.extent or usual, extents, text="%.0f", hint=hint)
    if entered is None or entered.value <= 0:
        return []
    extent = round(entered.value, 1)
    return [do(editing.edit_layer, layer_commands.set_depth, handle.id, handle.depth, extent)]
