"""Markers: names of frames, in a band below the ruler."""

from itertools import zip_longest

from imgui_bundle import ImVec2, imgui

from app.document import MARKER, Channel, Marker, scene_commands
from app.editor import Action, do
from app.editor.actions import editing, playback
from app.editor.actions.timing import keys, timeline_drag
from app.texts import _
from app.ui.shortcuts.widgets import draw_action_item
from app.ui.style.theme import SMALL, colour_u32
from app.ui.style.widgets import (
    begin_tooltip,
    is_hovered_or_held,
    name_popup,
    push_text_size,
    shorten_text,
)
from app.ui.timeline.keys import begin_key_drag, find_drag_origin, label_dragged_key
from app.ui.timeline.layout import TimelineLayout, format_seconds

MARKERS = Channel(MARKER)
HALF, GRIP = 0.42, 0.6  # em: half the width of a flag, and of its hit area
NAME_ROOM = 30.0  # em: longest name that can reach into view from a marker at the left
LEAST_NAME = 3.0  # em: names are omitted if less room is left


def draw_markers(bands: TimelineLayout) -> list[Action]:
    markers, em = bands.project.document.markers, bands.look.em
    if not markers:
        return []
    actions: list[Action] = []
    gesture = bands.project.timeline.gesture
    low, high = ImVec2(bands.left, bands.markers_top), ImVec2(bands.right, bands.track_bottom)
    draw_list = imgui.get_window_draw_list()
    draw_list.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    shown = list(bands.in_view(markers, room=NAME_ROOM))
    for index, after in zip_longest(shown, shown[1:]):
        marker = markers[index]
        x = bands.x(marker.frame)
        room = bands.size.x if after is None else bands.x(markers[after].frame) - x
        text = shorten_text(marker.name, room - 1.4 * em) if room > LEAST_NAME * em else ""
        width = imgui.calc_text_size(text).x if text else 0.0
        if not bands.shows(x - GRIP * em, x + GRIP * em + width):
            continue
        name = f"marker {find_drag_origin(gesture, MARKERS, marker.frame)}"
        end = x + max(GRIP * em, HALF * em + width)
        bands.button(
            name,
            ImVec2(x - GRIP * em, bands.markers_top),
            ImVec2(end, bands.camera_top),
            right=True,
        )
        _draw(bands, marker, x, text)
        actions += _point(bands, marker)
        actions += _menu(bands, marker)
        entered = name_popup(bands.look, f"name of marker {marker.frame}", marker.name)
        if entered is not None:
            actions.append(
                do(editing.edit_document, scene_commands.rename_marker(marker.frame, entered))
            )
    draw_list.pop_clip_rect()
    return actions


def _draw(bands: TimelineLayout, marker: Marker, x: float, text: str) -> None:
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    hot = is_hovered_or_held()
    is_chosen = marker.frame in bands.project.selection.keys.get(MARKERS, ())
    colour = palette.accent if hot or is_chosen else palette.anchor
    top, bottom = bands.markers_top + 0.15 * em, bands.camera_top - 0.1 * em
    waist = top + 0.55 * (bottom - top)
    half = HALF * em
    for point in (
        ImVec2(x - half, top),
        ImVec2(x + half, top),
        ImVec2(x + half, waist),
        ImVec2(x, bottom),
        ImVec2(x - half, waist),
    ):
        draw_list.path_line_to(point)
    draw_list.path_fill_convex(colour_u32(colour))
    begin, end = ImVec2(x, bands.camera_top), ImVec2(x, bands.track_bottom)
    draw_list.add_line(begin, end, colour_u32(colour, 0.8 if hot else 0.35), 1.0)
    if text and not bands.is_cramped:
        with push_text_size(SMALL):
            place = ImVec2(x + half + 0.3 * em, (top + bottom - imgui.get_text_line_height()) / 2)
            draw_list.add_text(place, colour_u32(palette.text if hot else palette.dim), text)
    label_dragged_key(bands, MARKERS, marker.frame, x)


def _point(bands: TimelineLayout, marker: Marker) -> list[Action]:
    document = bands.project.document
    if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
        imgui.open_popup(f"name of marker {marker.frame}")
        return [do(timeline_drag.end_timeline_drag)]
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        imgui.open_popup(f"menu of marker {marker.frame}")
        return []
    if bands.project.timeline.gesture is None and begin_tooltip():
        imgui.text_unformatted(marker.name)
        imgui.same_line()
        imgui.text_disabled(f"{marker.frame}, {format_seconds(marker.frame, document.fps)}")
        imgui.text_disabled(_("Click to go there, drag to move it, double-click to name it"))
        imgui.end_tooltip()
    return begin_key_drag(bands, MARKERS, marker.frame)


def _menu(bands: TimelineLayout, marker: Marker) -> list[Action]:
    asks = False
    actions: list[Action] = []
    if imgui.begin_popup(f"menu of marker {marker.frame}"):
        if imgui.menu_item_simple(_("Go there"), _("Click")):
            actions.append(do(playback.scrub, marker.frame))
        asks = imgui.menu_item_simple(_("Rename…"), _("Double-click"))
        if imgui.menu_item_simple(_("Delete")):
            actions.append(do(keys.delete_marker, marker.frame))
        imgui.separator()
        for spec in (playback.PREVIOUS_MARKER, playback.NEXT_MARKER):
            actions += draw_action_item(bands.session, spec)
        imgui.end_popup()
    if asks:
        imgui.open_popup(f"name of marker {marker.frame}")
    return actions
