"""The camera's keys, in a row of their own below the markers."""

from math import degrees, radians

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import CameraKey
from app.editor import Action, CameraDrag, do, layering
from app.editor.actions import playback, timeline_pointing
from app.ui.shortcuts import bound_item
from app.ui.style import Look, begin_tip, in_hand, ink, is_pressed, number, tip
from app.ui.timeline.bands import Bands, in_seconds, tag

HALF = 0.36  # em: half the width of a key
FIELD = 4.5  # em: width of the fields in its menu, and where they begin
MENU = "menu of the camera"


def draw_camera(bands: Bands) -> list[Action]:
    """Draw the row of the camera, if there is one, and take what the pointer does to its keys."""
    document, em = bands.project.document, bands.look.em
    if not document.camera:
        return []
    actions: list[Action] = []
    draw_list, palette = imgui.get_window_draw_list(), bands.look.palette
    top, bottom = bands.camera_top, bands.track_top
    middle = (top + bottom) / 2
    if bands.has_names:
        place = ImVec2(bands.corner.x + 0.6 * em, middle - imgui.get_text_line_height() / 2)
        draw_list.add_text(place, ink(palette.dim), f"{icons.ICON_FA_VIDEO}  Camera")
    draw_list.push_clip_rect(
        ImVec2(bands.left, top), ImVec2(bands.right, bottom), intersect_with_current_clip_rect=True
    )
    first, last = (bands.x(document.camera[end].frame) for end in (0, -1))
    draw_list.add_line(ImVec2(first, middle), ImVec2(last, middle), ink(palette.dim, 0.5), 1.5)
    gesture = bands.project.timing.gesture
    for index in bands.in_view(document.camera):
        key = document.camera[index]
        x, origin = bands.x(key.frame), key.frame
        if isinstance(gesture, CameraDrag) and gesture.at == key.frame:
            origin = gesture.key  # its button stays the same one while it is dragged
        low, high = ImVec2(x - 2 * HALF * em, top), ImVec2(x + 2 * HALF * em, bottom)
        bands.button(f"camera key {origin}", low, high, right=True)
        half, colour = HALF * em, palette.accent if in_hand() else palette.text
        draw_list.add_quad_filled(
            ImVec2(x - half, middle),
            ImVec2(x, middle - half),
            ImVec2(x + half, middle),
            ImVec2(x, middle + half),
            ink(colour),
        )
        if origin != key.frame:
            tag(bands, x, f"{key.frame}")
        actions += _point(bands, key)
        actions += _menu(bands, key)
    draw_list.pop_clip_rect()
    return actions


def _point(bands: Bands, key: CameraKey) -> list[Action]:
    document = bands.project.document
    if is_pressed():
        drag = CameraDrag(
            key=key.frame, at=key.frame, start=bands.pointed, before=document, after=document
        )
        return [do(timeline_pointing.begin, drag, bands.strip)]
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        imgui.open_popup(f"{MENU} {key.frame}")
    if bands.project.timing.gesture is None and begin_tip():
        imgui.text_unformatted(f"Camera, {key.zoom:.3g} times as large")
        imgui.same_line()
        imgui.text_disabled(f"{key.frame}, {in_seconds(key.frame, document.fps)}")
        imgui.text_disabled("Click to go there, drag to move it")
        imgui.end_tooltip()
    return []


def _field(look: Look, name: str, value: float, text: str) -> float | None:
    """Draw a field for a number of a key; return it when it was entered and is another."""
    imgui.align_text_to_frame_padding()
    imgui.text_unformatted(name)
    imgui.same_line(FIELD * look.em)
    imgui.set_next_item_width(FIELD * look.em)
    return number(f"camera {name}", value, text)


def _menu(bands: Bands, key: CameraKey) -> list[Action]:
    """Draw the menu of a key, if it is open."""
    actions: list[Action] = []
    if imgui.begin_popup(f"{MENU} {key.frame}"):
        if imgui.menu_item_simple("Go there", "Click"):
            actions.append(do(playback.scrub, key.frame))
        if imgui.menu_item_simple("Delete"):
            actions.append(do(layering.delete_camera_key, key.frame))
        imgui.separator()
        zoom = _field(bands.look, "Zoom", key.zoom, "%.3g")
        if zoom is not None:
            actions.append(do(layering.change_camera_key, key.frame, zoom=zoom))
        turn = _field(bands.look, "Turn", degrees(key.turn), "%.4g°")
        if turn is not None:
            actions.append(do(layering.change_camera_key, key.frame, turn=radians(turn)))
        tip("By how much things are seen turned, counter-clockwise")
        imgui.separator()
        for name in ("key camera", "look through"):
            actions += bound_item(bands.session, name)
        imgui.end_popup()
    return actions
