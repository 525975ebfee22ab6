"""Library poses that are dropped on the tracks."""

from imgui_bundle import ImVec2, imgui

from app.document import LAST_FRAME
from app.editor import Action, do
from app.editor.poses import library
from app.ui.style.theme import colour_u32
from app.ui.style.widgets import POSE_PAYLOAD
from app.ui.timeline.layout import TimelineLayout, draw_time_tag


def accept_dropped_pose(bands: TimelineLayout) -> list[Action]:
    """Preview the key that a dragged pose would make. Make the key when the pose is dropped."""
    payload = imgui.get_drag_drop_payload_py_id()
    if payload is None or payload.type != POSE_PAYLOAD:
        return []
    offers = library.list_library_poses(bands.project)
    if payload.data_id >= len(offers):
        return []
    if imgui.is_key_pressed(imgui.Key.escape):
        imgui.internal.clear_drag_drop()
        return []
    mouse = imgui.get_mouse_pos()
    frame = round(bands.pointed)
    is_over = bands.left <= mouse.x <= bands.right and bands.top <= mouse.y <= bands.bottom
    if not is_over or not 0 <= frame <= LAST_FRAME:
        return []
    draw_list, accent = imgui.get_window_draw_list(), colour_u32(bands.look.palette.accent)
    x = bands.x(frame)
    draw_list.add_line(ImVec2(x, bands.track_top), ImVec2(x, bands.track_bottom), accent, 2.0)
    draw_time_tag(bands, x, f"{frame}")
    if imgui.is_mouse_released(imgui.MouseButton_.left):
        owner, kept = offers[payload.data_id]
        return [do(library.apply_library_pose_at, kept.name, frame, owner.id)]
    return []
