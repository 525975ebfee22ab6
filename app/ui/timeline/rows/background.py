"""The empty area of the rows: a press selects keys by a box, a double click inserts a key."""

from imgui_bundle import ImVec2, imgui

from app.editor import Action, KeyBox, do
from app.editor.actions.timing import keys, timeline_drag
from app.ui.style.theme import colour_u32
from app.ui.style.widgets import draw_tooltip, is_pressed
from app.ui.timeline.keys import select_lane
from app.ui.timeline.layout import ROUNDING, TimelineLayout, was_dragged
from app.ui.timeline.menus import TRACK_MENU, draw_track_menu
from app.ui.timeline.row import ChannelLane
from app.ui.timeline.rows.track_residuals import describe_residual


def draw_track_background(bands: TimelineLayout) -> list[Action]:
    """Draw the animation's frames, and handle the pointer on the empty area."""
    palette, draw_list = bands.look.palette, imgui.get_window_draw_list()
    low, high = ImVec2(bands.left, bands.track_top), ImVec2(bands.right, bands.track_bottom)
    draw_list.add_rect_filled(low, high, colour_u32(palette.desk), ROUNDING * bands.look.em)
    draw_list.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    document = bands.project.document
    for frames, alpha in ((document.frames, 0.45), (document.played_frames, 1.0)):
        begin, end = bands.x(frames.first), bands.x(frames.last)
        draw_list.add_rect_filled(
            ImVec2(begin, low.y), ImVec2(end, high.y), colour_u32(palette.panel, alpha)
        )
    draw_list.pop_clip_rect()
    return _press_background(bands, ImVec2(bands.left, bands.camera_top), high)


def _press_background(bands: TimelineLayout, low: ImVec2, high: ImVec2) -> list[Action]:
    actions: list[Action] = []
    clicked = bands.button("ground", low, high, right=True)
    if is_pressed():
        actions += begin_key_box(bands)
    if clicked and is_plain_click():
        actions += select_lane(bands.pointed_channel, {})
    twice = imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
    channel, lane = bands.pointed_channel, bands.pointed_row
    if isinstance(lane, ChannelLane) and bands.project.timeline.gesture is None:
        layer, track, frame = lane.layer, lane.track, round(bands.pointed)
        if layer is not None and track is not None:
            miss = describe_residual(bands.project, layer, track, frame)
            if miss:
                draw_tooltip(miss)
    if twice and round(bands.pointed) in bands.project.document.frames:
        actions.append(do(keys.insert_key_in_row_at, round(bands.pointed)))
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        if channel != bands.project.channel:
            actions += select_lane(channel, {})
        imgui.open_popup(TRACK_MENU)
    return actions + draw_track_menu(bands)


def begin_key_box(bands: TimelineLayout) -> list[Action]:
    """Begin a box selection of keys. With Shift, it adds to the selected keys."""
    keeps = bands.project.selection.keys if imgui.get_io().key_shift else {}
    box = KeyBox(start=bands.pointed, channel=bands.pointed_channel, keeps=keeps)
    return [do(timeline_drag.begin_timeline_drag, box, bands.time_view)]


def is_plain_click() -> bool:
    """Return whether the left button was released without a drag and without Shift."""
    released = imgui.is_mouse_released(imgui.MouseButton_.left)
    return released and not was_dragged() and not imgui.get_io().key_shift


def draw_key_box(bands: TimelineLayout) -> None:
    gesture = bands.project.timeline.gesture
    if not isinstance(gesture, KeyBox) or not was_dragged():
        return
    draw_list, accent = imgui.get_window_draw_list(), bands.look.palette.accent
    mouse = imgui.get_mouse_pos()
    delta = imgui.get_mouse_drag_delta(imgui.MouseButton_.left)
    top, bottom = sorted((mouse.y - delta.y, mouse.y))
    left, right = sorted((bands.x(gesture.start), mouse.x))
    low = ImVec2(left, max(top, bands.camera_top))
    high = ImVec2(right, min(bottom, bands.track_bottom))
    draw_list.add_rect_filled(low, high, colour_u32(accent, 0.14), 2.0)
    draw_list.add_rect(low, high, colour_u32(accent, 0.8), 2.0)
