"""The depth of a handle: which part is painted in front where the drawing overlaps itself."""

from imgui_bundle import imgui

from app.document import DEFAULT_DEPTH_EXTENT, Handle, Keyframe, Layer, layer_commands
from app.editor import Action, Project, Session, do
from app.editor.actions import editing, playback, viewing
from app.editor.actions.layer_setup import handle_editing
from app.texts import _
from app.ui.style.sliders import Scale, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import draw_tooltip, heading, label, small_text
from engine.geometry import diameter

DEPTHS = Scale(left=-1.0, right=1.0)


def draw_depth_settings(
    session: Session, look: Look, project: Project, handle: Handle
) -> list[Action]:
    """Draw the depth of a handle, its extent, and its first key."""
    heading(look, _("In front"))
    layer, frame = project.layer, playback.edited_frame(session, project)
    key = layer.key(frame) if frame in layer.key_frames else None
    imgui.begin_group()
    actions = _depth(session, look, project, handle) + _extent(look, layer, handle)
    if len(layer.keys) > 1:
        actions += _from_key(look, handle, key)
    imgui.end_group()
    # The drawing is tinted while the pointer is on these settings.
    is_pointed = imgui.is_item_hovered(imgui.HoveredFlags_.rect_only) and imgui.is_window_hovered(
        imgui.HoveredFlags_.allow_when_blocked_by_active_item
    )
    if is_pointed != (session.tint == "depth"):
        actions.append(do(viewing.set_tint, "depth" if is_pointed else None))
    return actions


def _depth(session: Session, look: Look, project: Project, handle: Handle) -> list[Action]:
    label(look, _("Depth"))
    hint = _("Order where the drawing overlaps itself: −1 paints this part behind, 1 in front")
    front = handle_editing.depth_at_playhead(session, project, handle)
    entered = slider(look, "depth", front, DEPTHS, text="%.2f", hint=hint)
    if entered is None:
        return []
    value = round(min(max(entered.value, -1.0), 1.0), 2)
    return [do(handle_editing.set_depth, handle.id, value)]


def _extent(look: Look, layer: Layer, handle: Handle) -> list[Action]:
    label(look, _("Extent"))
    usual = DEFAULT_DEPTH_EXTENT * diameter(layer.domain.outline)
    extents = Scale(left=0.1 * usual, right=8 * usual, logarithmic=True)
    hint = _("How far the depth reaches around the handle, in pixels along the drawing")
    entered = slider(look, "extent", handle.extent or usual, extents, text="%.0f", hint=hint)
    if entered is None or entered.value <= 0:
        return []
    return [_set(handle, handle.depth, round(entered.value, 1))]


def _from_key(look: Look, handle: Handle, key: Keyframe | None) -> list[Action]:
    """Draw whether the depth belongs to a key and holds from there on."""
    front = key.depths.get(handle.id) if key else None
    imgui.begin_disabled(key is None)
    changed, keyed = imgui.checkbox(_("From this key on"), front is not None)
    imgui.end_disabled()
    draw_tooltip(_("The depth lasts until the next key with a depth"))
    if key is None:
        small_text(look, _("Go to a key to change the depth there."))
        return []
    return [_set_in_key(key, handle, handle.depth if keyed else None)] if changed else []


def _set_in_key(key: Keyframe, handle: Handle, front: float | None) -> Action:
    return do(editing.edit_layer, layer_commands.key_depth, key.frame, handle.id, front)


def _set(handle: Handle, front: float, extent: float | None) -> Action:
    return do(editing.edit_layer, layer_commands.set_depth, handle.id, front, extent)
