"""The viewport's panel: the drawing, and everything that the pointer does to it."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui, imgui_ctx

from app.document import WEIGHT_PRESETS, Handle, handle_commands, value_at
from app.editor import Action, Project, Session, do
from app.editor.actions import editing, playback, viewing
from app.editor.actions.layer_setup import handle_editing
from app.editor.actions.posing.handles import remove_handles, suggest_handles
from app.editor.actions.posing.limb_editing import flip_selected_joints
from app.editor.actions.posing.pose_drag import free_rotation, pin_selected_handles
from app.editor.actions.timing import keys, tracks
from app.editor.layering.anchors import toggle_anchor_at_handle
from app.editor.layering.layer_selection import reset_tree_rows
from app.editor.poses import copying, pasting
from app.editor.tools import move_tool, tool_pointer
from app.editor.tools.edit_tools.stiffness_tools import layer_bones
from app.editor.tools.table import is_on_gizmo, pointed_tool, tools_of
from app.editor.tools.tool import PointerHit
from app.texts import _
from app.ui.panel import is_in_front
from app.ui.shortcuts.keys import CTRL, format_modified, shown_keys
from app.ui.shortcuts.widgets import draw_action_item
from app.ui.style.theme import Look, pixel_density
from app.ui.style.widgets import is_hovered_or_held, is_pressed, menu_entry
from app.ui.viewport.backdrop import draw_camera_frame
from app.ui.viewport.interaction.drag import follow_pointer
from app.ui.viewport.interaction.gizmos import add_mirror_axis_gizmo, draw_mirror_axis
from app.ui.viewport.interaction.hints import draw_badges, find_hint
from app.ui.viewport.interaction.recording import add_track_key_gizmos, draw_recording_bar
from app.ui.viewport.interaction.shapes import draw_shapes
from app.ui.viewport.marks import find_off_target
from app.ui.viewport.screen import GRIP, ScreenMapping
from app.ui.viewport.split_view import (
    SplitTextures,
    divide_viewport,
    draw_divider,
    draw_split_pictures,
)

ZOOM_STEP = 1.15  # per notch of the wheel
SMALLEST_ZOOM, LARGEST_ZOOM = 0.02, 64.0
LEFT = imgui.MouseButton_.left
LEFT_OR_RIGHT = imgui.ButtonFlags_.mouse_button_left | imgui.ButtonFlags_.mouse_button_right
ANY_BUTTON = LEFT_OR_RIGHT | imgui.ButtonFlags_.mouse_button_middle
# The menu of the canvas. A separator splits two groups.
CANVAS = (
    (keys.insert_key_in_row, copying.copy_pose_or_keys, pasting.PASTE, pasting.PASTE_FLIPPED),
    (suggest_handles, editing.select_all, move_tool.toggle_move_tool),
    (viewing.zoom_to_pose, viewing.zoom_to_motion, viewing.zoom_to_actual_size),
    (viewing.HANDLES, viewing.OUTLINE, viewing.ONION_SKIN),
)
CURSORS = {
    "hand": imgui.MouseCursor_.hand,
    "move": imgui.MouseCursor_.resize_all,
    "resize": imgui.MouseCursor_.resize_ew,
}
DEPTHS = {_("In front"): 1.0, _("Normal order"): 0.0, _("Behind"): -1.0}


def draw_viewport_pictures(
    session: Session, project: Project, pictures: SplitTextures
) -> list[Action]:
    """Show the project's pictures.

    In a split viewport, `pictures` also has the compared method's picture.
    """
    parts = divide_viewport(session, imgui.get_window_pos(), imgui.get_window_size())
    if (
        project.layer_runtime.shown is not None
        and pictures.own is not None
        and min(parts.room) >= 1
    ):
        draw_split_pictures(parts, pictures.own, pictures.comparison)
    return _fit(session, parts.room)


def draw_viewport_panel(
    session: Session, look: Look, project: Project, pictures: SplitTextures
) -> list[Action]:
    """Draw the overlays over the pictures, and handle the pointer."""
    corner, whole = imgui.get_window_pos(), imgui.get_window_size()
    parts, actions = divide_viewport(session, corner, whole), list[Action]()
    if project.layer_runtime.shown is None or pictures.own is None or min(parts.room) < 1:
        return actions
    screen = ScreenMapping(session, project, project.layer_runtime.shown, corner)
    if not session.tools.is_cutting:
        draw_camera_frame(look, project, screen, (corner, parts.room))
    # Before the canvas: the first item under the pointer takes the press. If the buttons came
    # later, the canvas or no item would take a press in the frame in which the pointer arrives.
    with imgui_ctx.push_clip_rect(corner, corner + parts.room, True):  # noqa: FBT003 - within its own
        actions += draw_recording_bar(look, project, corner)
        handles = _add_handle_buttons(session, look, screen)
        track_key, is_key_pressed = add_track_key_gizmos(session, look, screen)
        axis = add_mirror_axis_gizmo(session, look, screen)
    actions += draw_divider(session, look, parts, whole.x)
    imgui.set_cursor_screen_pos(corner)
    imgui.invisible_button("canvas", parts.room, ANY_BUTTON)
    on_canvas = imgui.is_item_hovered()
    is_over = on_canvas or axis.is_hot or not handles.hovered is track_key is None
    spot = screen.hit_test(look, handles.hovered, on_axis=axis.is_hot)
    on_gizmo = on_canvas and handles.hovered is None and is_on_gizmo(session, project, spot)
    spot = replace(
        spot, at_target=handles.at_target, track_key=track_key, on_gizmo=on_gizmo, is_over=is_over
    )
    if handles.is_pressed or is_key_pressed or axis.is_pressed or _is_canvas_pressed():
        actions.append(do(tool_pointer.press_pointer, spot))
    actions += _canvas_menu(session, is_pointed=on_canvas and handles.hovered is None)
    actions += _navigate(screen)
    actions += handles.actions
    actions += follow_pointer(session, look, screen)
    tool = session.tools.active_tool or pointed_tool(session, project, spot)
    if tool is not None and tool.cursor in CURSORS and (is_over or session.tools.active_tool):
        imgui.set_mouse_cursor(CURSORS[tool.cursor])
    if handles.hovered != session.tools.hovered:
        actions.append(do(tool_pointer.hover_handle, handles.hovered))
    draw_mirror_axis(look, axis)
    actions += _update_hint(session, screen, spot, is_over=is_over)
    if session.display.tint == "stiffness" and not is_in_front("Shape"):
        actions.append(do(viewing.set_tint, None))
    if _shows_handles(session, project):
        draw_shapes(look, screen, layer_bones(project, spot.em))
    for offered in tools_of(session):
        draw_shapes(look, screen, offered.idle_shapes(session, project, spot))
    return actions + draw_badges(session, look, project, corner, parts.room)


def _fit(session: Session, room: ImVec2) -> list[Action]:
    """Resize the picture to the pixels of its room."""
    width, height = (max(1, round(side * pixel_density())) for side in room)
    return (
        []
        if (width, height) == session.display.screen
        else [do(viewing.set_viewport_size, width, height)]
    )


def _update_hint(
    session: Session, screen: ScreenMapping, spot: PointerHit, *, is_over: bool
) -> list[Action]:
    """Set the hint for the place under the pointer. No row of layers is under it."""
    actions = [do(reset_tree_rows)] if is_over and screen.project.layer_list.lingering else []
    if session.tools.hint_source and not is_over:
        return actions
    if session.tools.active_tool is not None and not imgui.is_mouse_dragging(LEFT):
        # A click is no drag.
        return actions
    hint = find_hint(session, screen, spot) if is_over else ""
    return actions if hint == session.tools.hint else [*actions, do(tool_pointer.show_hint, hint)]


def _is_canvas_pressed() -> bool:
    """Return whether the canvas, the last item, was pressed, and not to move the view."""
    return is_pressed() and not imgui.is_key_down(imgui.Key.space)


def _navigate(screen: ScreenMapping) -> list[Action]:
    """Pan with the middle button, or Space and the left button. Zoom with the wheel."""
    io, view = imgui.get_io(), screen.view
    if not (imgui.is_window_hovered() or imgui.is_item_active()):
        return []
    with_space = imgui.is_key_down(imgui.Key.space) and imgui.is_mouse_down(0)
    if imgui.is_mouse_down(imgui.MouseButton_.middle) or with_space:
        delta = complex(*io.mouse_delta) * screen.density
        actions = [do(tool_pointer.note_space_used)] if with_space else []
        return [*actions, do(viewing.set_view, view.panned(delta))] if delta else actions
    if io.mouse_wheel:
        scale = min(max(view.scale * ZOOM_STEP**io.mouse_wheel, SMALLEST_ZOOM), LARGEST_ZOOM)
        return [do(viewing.set_view, view.zoomed(scale / view.scale, screen.pixel))]
    return []


class _Handles(NamedTuple):
    """The handle under the pointer, whether it was pressed, and the actions of handle menus."""

    hovered: int | None
    at_target: bool  # whether the pointer is on the handle's target and not on the handle
    is_pressed: bool
    actions: list[Action]


def _shows_handles(session: Session, project: Project) -> bool:
    """Return whether handles and bones are visible: not during playback, nor in the rest picture.

    While a motion preset is set up, its joints replace the handles.
    """
    is_away = project.timeline.playhead.since is not None or session.tools.motion_setup is not None
    return session.display.overlays.handles and not session.tools.is_cutting and not is_away


def _add_handle_buttons(session: Session, look: Look, screen: ScreenMapping) -> _Handles:
    """Lay a button over each handle, and over its target if the handle has not arrived there."""
    hovered, at_target, pressed, actions = None, False, False, list[Action]()
    if not _shows_handles(session, screen.project):
        return _Handles(hovered, at_target, pressed, actions)
    radius, shown = ImVec2(GRIP * look.em, GRIP * look.em), screen.shown
    identities = [handle.id for handle in shown.clip.layer.handles]
    targets = find_off_target(screen.project, shown)
    grips = [("target", identity) for identity in targets]
    grips += [("handle", identity) for identity in identities]
    places = np.array([*targets.values(), *shown.handle_positions], np.complex128)
    points = screen.points(shown.placement.apply(places))
    # The mark that is drawn last lies on top.
    for (what, identity), point in reversed(list(zip(grips, points, strict=True))):
        imgui.set_cursor_screen_pos(point - radius)
        imgui.invisible_button(f"{what} {identity}", radius * 2, LEFT_OR_RIGHT)
        if is_hovered_or_held():
            hovered, at_target = identity, what == "target"
        pressed = pressed or is_pressed()
        if session.tools.active_tool is None and imgui.is_item_clicked(imgui.MouseButton_.right):
            imgui.open_popup(f"menu of handle {identity}")
            if identity not in screen.project.selection.handles:
                actions.append(do(editing.select_handles, frozenset({identity})))
    # The shown frame may predate the last edit of the layer.
    for handle in screen.project.layer.handles:
        actions += _handle_menu(session, screen, handle)
    return _Handles(hovered, at_target, pressed, actions)


def _canvas_menu(session: Session, *, is_pointed: bool) -> list[Action]:
    """Draw the canvas menu if it is open. A right click on the canvas opens it."""
    is_free = is_pointed and session.tools.active_tool is None and not session.tools.is_cutting
    if is_free and imgui.is_mouse_clicked(imgui.MouseButton_.right):
        imgui.open_popup("menu of the canvas")
    actions: list[Action] = []
    if not imgui.begin_popup("menu of the canvas"):
        return actions
    for number, group in enumerate(CANVAS):
        if number:
            imgui.separator()
        for spec in group:
            actions += draw_action_item(session, spec)
    imgui.end_popup()
    return actions


def _handle_menu(session: Session, screen: ScreenMapping, handle: Handle) -> list[Action]:
    """Draw a handle's menu if it is open. Its actions apply to all selected handles."""
    actions: list[Action] = []
    layer, identity = screen.project.layer, handle.id
    if not imgui.begin_popup(f"menu of handle {identity}"):
        return actions
    chosen = screen.project.selection.handles | {identity}
    target = screen.shown.pose.targets.get(identity) if screen.shown.pose else None
    if menu_entry(_("Delete"), icons.ICON_FA_TRASH, shown_keys(editing.delete_selection)):
        actions.append(do(remove_handles, chosen))
    for spec in (
        pin_selected_handles,
        handle_editing.toggle_handles_locked,
        tracks.key_selected_handles,
        *((flip_selected_joints,) if identity in layer.bone_joints else ()),
    ):
        actions += draw_action_item(session, spec)
    actions += _hold(handle, chosen) + _depth(session, screen, handle)
    imgui.separator()
    is_anchor = handle.position == layer.anchor
    label = _("Automatic anchor") if is_anchor else _("Make anchor")
    if menu_entry(label, icons.ICON_FA_ANCHOR, format_modified(CTRL, _("click"))):
        actions.append(do(toggle_anchor_at_handle, identity))
    is_turned = target is not None and target.rotation is not None
    reason = None if is_turned else _("The handle already turns freely.")
    if menu_entry(_("Turn freely"), icons.ICON_FA_ROTATE, reason=reason):
        actions.append(do(free_rotation, identity))
    imgui.end_popup()
    return actions


def _hold(handle: Handle, chosen: frozenset[int]) -> list[Action]:
    if not imgui.begin_menu(_("Hold")):
        return []
    weigh = handle_commands.set_handle_weight
    actions = [
        do(editing.edit_layer, weigh, chosen, weight)
        for word, weight in WEIGHT_PRESETS.items()
        if imgui.menu_item(_(word), "", handle.weight == weight)[0]
    ]
    imgui.end_menu()
    return actions


def _depth(session: Session, screen: ScreenMapping, handle: Handle) -> list[Action]:
    """Draw the handle's depth: in front or behind where the drawing overlaps itself."""
    if not imgui.begin_menu(_("Depth")):
        return []
    channel = handle_editing.depth_channel(screen.project, handle)
    frame = playback.current_frame(session, screen.project)
    front = value_at(screen.project.document, channel, frame)
    actions = [
        do(handle_editing.set_depth, handle.id, depth)
        for word, depth in DEPTHS.items()
        if imgui.menu_item(word, "", front == depth)[0]
    ]
    imgui.end_menu()
    return actions
