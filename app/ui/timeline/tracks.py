"""Rows of tracks: names, active ranges, keys, and target errors."""

from collections.abc import Collection
from itertools import pairwise

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import Layer, Track, TrackKey, track_commands
from app.editor import Action, KeyDrag, TrackRow, do, row_of
from app.editor.actions import editing
from app.editor.actions.timing import timeline_drag
from app.texts import _, ngettext
from app.ui.shortcuts.keys import CTRL, format_modified
from app.ui.style.theme import CHOSEN, SMALL, colour_u32
from app.ui.style.widgets import (
    begin_tooltip,
    draw_tooltip,
    is_hovered_or_held,
    push_text_size,
    shorten_text,
)
from app.ui.timeline.keys import (
    KEY_GESTURES,
    begin_key_drag,
    draw_key_mark,
    find_drag_origin,
    is_key_dragged,
    label_dragged_key,
    select_row,
)
from app.ui.timeline.layout import (
    THIN,
    LayerRow,
    TimelineLayout,
    TrackLane,
    find_least_gap,
    format_seconds,
)
from app.ui.timeline.menus import TANGENT_MODES, draw_key_menu
from app.ui.timeline.track_residuals import find_residuals

RADIUS, GRIP = 0.4, 0.55  # em: half a key's diagonal, and half its hit box
SEGMENT_HEIGHT, DELAY_HEIGHT = (
    0.22,
    0.1,
)  # em: heights of the line of a track's active range, and of its delay
EXPANDER_WIDTH = 1.1  # em: width of the triangle that collapses tracks


def format_track_name(layer: Layer, track: Track) -> str:
    return ", ".join(layer.handle(identity).name for identity in track.handles)


def draw_expander(bands: TimelineLayout, row: LayerRow, left: float) -> list[Action]:
    """Draw the triangle that collapses a layer's tracks, if the layer has any."""
    layer, em = row.layer, bands.look.em
    if not layer.tracks:
        return []
    half = THIN / 2 * em
    low, high = (
        ImVec2(left, row.middle - half),
        ImVec2(left + EXPANDER_WIDTH * em, row.middle + half),
    )
    clicked = bands.button(f"fold {layer.id}", low, high)
    is_open = layer.id in bands.project.timeline.expanded_layers
    count = len(layer.tracks)
    hide = ngettext("Hide the track", "Hide {count} tracks", count)
    show = ngettext("Show the track", "Show {count} tracks", count)
    draw_tooltip((hide if is_open else show).format(count=count))
    palette = bands.look.palette
    icon = icons.ICON_FA_CARET_DOWN if is_open else icons.ICON_FA_CARET_RIGHT
    top = row.middle - imgui.get_text_line_height() / 2
    colour = colour_u32(palette.text if is_hovered_or_held() else palette.dim)
    imgui.get_window_draw_list().add_text(ImVec2(left + 0.3 * em, top), colour, icon)
    return [do(timeline_drag.toggle_track_rows, layer.id)] if clicked else []


def draw_track_names(bands: TimelineLayout) -> list[Action]:
    """Draw the names of tracks beside their rows, with their on/off buttons."""
    actions: list[Action] = []
    for lane in filter(bands.shows_row, bands.track_rows):
        imgui.push_id(f"track {lane.layer.id} {lane.track.handles[0]}")
        actions += _draw_name(bands, lane)
        imgui.pop_id()
    return actions


def _draw_name(bands: TimelineLayout, lane: TrackLane) -> list[Action]:
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    layer, track, row = lane.layer, lane.track, row_of(lane.layer, lane.track)
    low = ImVec2(bands.corner.x, lane.top)
    high = ImVec2(bands.left - 0.3 * em, lane.bottom)
    actions: list[Action] = []
    if bands.button("name", low, high):
        actions += select_row(row, {})
        actions.append(do(editing.select_handles, frozenset(track.handles)))
    if lane.is_chosen or is_hovered_or_held():
        colour = (
            colour_u32(palette.accent, CHOSEN) if lane.is_chosen else colour_u32(palette.hovered)
        )
        draw_list.add_rect_filled(low, high, colour, 0.2 * em)
    draw_tooltip(_("Click to select the track: then keys and drags of its handle go to the track"))
    switch = high.x - 2.0 * em
    with push_text_size(SMALL):
        top = lane.middle - imgui.get_text_line_height() / 2
        icon = icons.ICON_FA_THUMBTACK if track.is_scene_space else icons.ICON_FA_ROUTE
        text = shorten_text(format_track_name(layer, track), switch - low.x - 3.4 * em)
        colour = colour_u32(palette.text if track.enabled else palette.dim)
        draw_list.add_text(ImVec2(low.x + 1.4 * em, top), colour_u32(palette.dim), icon)
        draw_list.add_text(ImVec2(low.x + 2.9 * em, top), colour, text)
    clicked = bands.button("switch", ImVec2(switch, lane.top), high)
    draw_tooltip(
        _("Switch the track off: its keys stay") if track.enabled else _("Switch the track on")
    )
    icon = icons.ICON_FA_TOGGLE_ON if track.enabled else icons.ICON_FA_TOGGLE_OFF
    colour = colour_u32(palette.accent if track.enabled else palette.dim)
    with push_text_size(SMALL):
        draw_list.add_text(ImVec2(switch + 0.3 * em, top), colour, icon)
    if clicked:
        command = track_commands.enable_track(layer.id, track.handles[0], enabled=not track.enabled)
        actions.append(do(editing.edit_document, command))
    return actions


def draw_track_segments(bands: TimelineLayout) -> None:
    """Draw the backgrounds of tracks' rows, active ranges, and target errors."""
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    for lane in filter(bands.shows_row, bands.track_rows):
        low, high = ImVec2(bands.left, lane.top), ImVec2(bands.right, lane.bottom)
        draw_list.add_rect_filled(low, high, colour_u32(palette.desk, 0.45))
        if lane.is_chosen:
            draw_list.add_rect_filled(low, high, colour_u32(palette.accent, 0.16))
        draw_list.add_line(ImVec2(low.x, high.y), high, colour_u32(palette.line))
        colour = colour_u32(palette.text if lane.track.enabled else palette.dim, 0.35)
        for first, last in _active_ranges(bands, lane.track):
            half = SEGMENT_HEIGHT / 2 * em
            draw_list.add_rect_filled(
                ImVec2(bands.x(first), lane.middle - half),
                ImVec2(bands.x(last), lane.middle + half),
                colour,
                half,
            )
        _draw_delay(bands, lane)
        for first, last in _runs(find_residuals(bands.project, lane.layer, lane.track)):
            draw_list.add_rect_filled(
                ImVec2(bands.x(first - 0.5), lane.top + 1),
                ImVec2(bands.x(last + 0.5), lane.bottom - 1),
                colour_u32(palette.danger, 0.55),
            )


def _active_ranges(bands: TimelineLayout, track: Track) -> list[tuple[int, int]]:
    """Return a track's active ranges. The end of a loop splits the range in two."""
    document = bands.project.document
    first, last = track.keys[0].frame + track.delay, track.keys[-1].frame + track.delay
    frames = document.frames
    period = frames.last - frames.first
    if not document.loop or last <= frames.last:
        return [(first, last)]
    if first > frames.last:
        return [(first - period, last - period)]
    return [(first, frames.last), (frames.first, last - period)]


def _draw_delay(bands: TimelineLayout, lane: TrackLane) -> None:
    """Draw the delay of a track as a line from its undelayed first key."""
    if not lane.track.delay:
        return
    em, first = bands.look.em, lane.track.keys[0].frame
    begin, end = bands.x(first), bands.x(first + lane.track.delay)
    y, colour = lane.bottom - 0.22 * em, colour_u32(bands.look.palette.anchor, 0.9)
    draw_list = imgui.get_window_draw_list()
    draw_list.add_line(ImVec2(begin, y), ImVec2(end, y), colour, DELAY_HEIGHT * em)
    draw_list.add_line(
        ImVec2(begin, y - 0.15 * em), ImVec2(begin, y + 0.15 * em), colour, DELAY_HEIGHT * em
    )


def _runs(frames: Collection[int]) -> list[tuple[int, int]]:
    """Return the first and last frame of each run of consecutive frames."""
    ordered = sorted(frames)
    cuts = [index for index, (one, other) in enumerate(pairwise(ordered), 1) if other - one > 1]
    parts = pairwise([0, *cuts, len(ordered)]) if ordered else ()
    return [(ordered[begin], ordered[end - 1]) for begin, end in parts]


def draw_track_keys(bands: TimelineLayout) -> list[Action]:
    actions: list[Action] = []
    bands.push_track_clip()
    for lane in filter(bands.shows_row, bands.track_rows):
        imgui.push_id(f"track {lane.layer.id} {lane.track.handles[0]}")
        for index in _in_view(bands, lane.track):
            actions += _key(bands, lane, lane.track.keys[index])
        imgui.pop_id()
    imgui.pop_clip_rect()
    return actions


def _in_view(bands: TimelineLayout, track: Track) -> list[int]:
    """Return the indices of a track's visible keys. In a loop, late keys wrap around."""
    document = bands.project.document
    round_ = document.frames.last - document.frames.first
    shifts = {track.delay, track.delay - round_ * document.loop}
    return sorted({index for late in shifts for index in bands.in_view(track.keys, late=late)})


def _key(bands: TimelineLayout, lane: TrackLane, key: TrackKey) -> list[Action]:
    em, gesture = bands.look.em, bands.project.timeline.gesture
    row = TrackRow(lane.layer.id, lane.track.handles[0])
    gap = find_least_gap(lane.layer, lane.track.handles[0])
    room = max(0.48 * gap * bands.time_view.scale, 0.24)
    x, grip, radius = bands.x_of(lane.track, key.frame), GRIP * em, min(room, RADIUS) * em
    if not bands.shows(x - grip, x + grip):
        return []
    grip = min(grip, 1.4 * radius)
    low, high = ImVec2(x - grip, lane.middle - grip), ImVec2(x + grip, lane.middle + grip)
    bands.button(f"key {find_drag_origin(gesture, row, key.frame)}", low, high, right=True)
    is_large = is_hovered_or_held() or is_key_dragged(gesture, row, key.frame)
    _draw_key(bands, lane, key, ImVec2(x, lane.middle), (1.15 if is_large else 1.0) * radius)
    actions = begin_key_drag(bands, row, key.frame)
    label_dragged_key(bands, row, key.frame, x)
    if not isinstance(gesture, KeyDrag):
        _draw_track_key_tooltip(bands, lane, key)
    return actions + draw_key_menu(bands, row, key)


def _draw_key(
    bands: TimelineLayout, lane: TrackLane, key: TrackKey, centre: ImVec2, radius: float
) -> None:
    palette, em, tangent = bands.look.palette, bands.look.em, key.shown_tangent_mode
    row = TrackRow(lane.layer.id, lane.track.handles[0])
    is_chosen = key.frame in bands.project.selected_keys.get(row, ())
    colour = palette.text if lane.track.enabled else palette.dim
    if is_chosen:
        draw_key_mark(tangent, centre, radius + 0.2 * em, colour_u32(palette.accent, 0.35))
    draw_key_mark(tangent, centre, radius + 0.1 * em, colour_u32(palette.desk))
    draw_key_mark(tangent, centre, radius, colour_u32(palette.accent if is_chosen else colour))


def _draw_track_key_tooltip(bands: TimelineLayout, lane: TrackLane, key: TrackKey) -> None:
    if not begin_tooltip():
        return
    document, track = bands.project.document, lane.track
    imgui.text_unformatted(
        _("Key of {track} at frame {frame}").format(
            track=format_track_name(lane.layer, track), frame=key.frame
        )
    )
    if track.delay:
        imgui.same_line()
        imgui.text_disabled(
            ngettext(
                "{count} frame late, {time}", "{count} frames late, {time}", track.delay
            ).format(count=track.delay, time=format_seconds(track.delay, document.fps))
        )
    name, hint = TANGENT_MODES[key.shown_tangent_mode]
    imgui.text_unformatted(name)
    imgui.text_disabled(hint)
    if key.velocity is not None:
        imgui.text_disabled(
            _("The key has its own velocity, until you choose a tangent or an easing")
        )
    imgui.text_disabled(KEY_GESTURES.format(gesture=format_modified(CTRL, _("drag"))))
    imgui.end_tooltip()
