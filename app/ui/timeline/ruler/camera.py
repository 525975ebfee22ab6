"""The camera's keys, in their own row below the markers."""

from math import degrees, radians

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import CameraKey
from app.editor import Action, CameraDrag, do
from app.editor.actions import playback
from app.editor.actions.timing import timeline_drag
from app.editor.layering.layer_channels import change_camera_key, delete_camera_key
from app.texts import _
from app.ui.shortcuts.widgets import draw_action_item
from app.ui.style.sliders import number_field
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import begin_tooltip, draw_tooltip, is_hovered_or_held, is_pressed
from app.ui.timeline.layout import TimelineLayout, draw_time_tag, format_seconds

HALF = 0.36  # em: half the width of a key
FIELD = 4.5  # em: width and position of the fields in the menu
MENU = "menu of the camera"


def draw_camera_row(bands: TimelineLayout) -> list[Action]:
    """Draw the camera row, if there are keys, and handle the pointer on them."""
    document, em = bands.project.document, bands.look.em
    if not document.camera:
        return []
    actions: list[Action] = []
    draw_list, palette = imgui.get_window_draw_list(), bands.look.palette
    top, bottom = bands.camera_top, bands.track_top
    middle = (top + bottom) / 2
    if bands.has_names:
        place = ImVec2(bands.corner.x + 0.6 * em, middle - imgui.get_text_line_height() / 2)
        draw_list.add_text(place, colour_u32(palette.dim), f"{icons.ICON_FA_VIDEO}  {_('Camera')}")
    draw_list.push_clip_rect(
        ImVec2(bands.left, top), ImVec2(bands.right, bottom), intersect_with_current_clip_rect=True
    )
    first, last = (bands.x(document.camera[end].frame) for end in (0, -1))
    draw_list.add_line(
        ImVec2(first, middle), ImVec2(last, middle), colour_u32(palette.dim, 0.5), 1.5
    )
    gesture = bands.project.timeline.gesture
    for index in bands.in_view(document.camera):
        key = document.camera[index]
        x, origin = bands.x(key.frame), key.frame
        if isinstance(gesture, CameraDrag) and gesture.at == key.frame:
            origin = gesture.key  # its button keeps its id during a drag
        low, high = ImVec2(x - 2 * HALF * em, top), ImVec2(x + 2 * HALF * em, bottom)
        bands.button(f"camera key {origin}", low, high, right=True)
        half, colour = HALF * em, palette.accent if is_hovered_or_held() else palette.text
        draw_list.add_quad_filled(
            ImVec2(x - half, middle),
            ImVec2(x, middle - half),
            ImVec2(x + half, middle),
            ImVec2(x, middle + half),
            colour_u32(colour),
        )
        if origin != key.frame:
            draw_time_tag(bands, x, f"{key.frame}")
        actions += _point(bands, key)
        actions += _menu(bands, key)
    draw_list.pop_clip_rect()
    return actions


def _point(bands: TimelineLayout, key: CameraKey) -> list[Action]:
    document = bands.project.document
    if is_pressed():
        drag = CameraDrag(
            key=key.frame, at=key.frame, start=bands.pointed, before=document, after=document
        )
        return [do(timeline_drag.begin_timeline_drag, drag, bands.time_view)]
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        imgui.open_popup(f"{MENU} {key.frame}")
    if bands.project.timeline.gesture is None and begin_tooltip():
        imgui.text_unformatted(_("Camera, {zoom:.3g} times as large").format(zoom=key.zoom))
        imgui.same_line()
        imgui.text_disabled(f"{key.frame}, {format_seconds(key.frame, document.fps)}")
        imgui.text_disabled(_("Click to go there, drag to move it"))
        imgui.end_tooltip()
    return []


def _field(look: Look, name: str, value: float, text: str) -> float | None:
    """Draw a field for a number of a key. Return the number when a different one was entered."""
    imgui.align_text_to_frame_padding()
    imgui.text_unformatted(name)
    imgui.same_line(FIELD * look.em)
    imgui.set_next_item_width(FIELD * look.em)
    return number_field(f"camera {name}", value, text)


def _menu(bands: TimelineLayout, key: CameraKey) -> list[Action]:
    actions: list[Action] = []
    if imgui.begin_popup(f"{MENU} {key.frame}"):
        if imgui.menu_item_simple(_("Go there"), _("Click")):
            actions.append(do(playback.scrub, key.frame))
        if imgui.menu_item_simple(_("Delete")):
            actions.append(do(delete_camera_key, key.frame))
        imgui.separator()
        zoom = _field(bands.look, _("Zoom"), key.zoom, "%.3g")
        if zoom is not None:
            actions.append(do(change_camera_key, key.frame, zoom=zoom))
        turn = _field(bands.look, _("Turn"), degrees(key.turn), "%.4g°")
        if turn is not None:
            actions.append(do(change_camera_key, key.frame, turn=radians(turn)))
        draw_tooltip(_("Rotation of the picture, counter-clockwise"))
        imgui.separator()
        for name in ("key camera", "look through"):
            actions += draw_action_item(bands.session, name)
        imgui.end_popup()
    return actions
