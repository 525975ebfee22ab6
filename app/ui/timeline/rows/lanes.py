"""Lanes: the keys of channels other than poses, with their names."""

from collections.abc import Sequence
from typing import Any

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import (
    VOLUME,
    BaseKey,
    Channel,
    Layer,
    TangentMode,
    Track,
    TrackKey,
    describe_channel,
    keys_in,
    track_commands,
)
from app.editor import Action, KeyDrag, do
from app.editor.actions import editing
from app.editor.actions.timing import timeline_drag
from app.texts import _, ngettext
from app.ui.shortcuts.keys import CTRL, format_modified
from app.ui.style.theme import CHOSEN, SMALL, colour_u32, icon_glyph
from app.ui.style.values import format_value, label_value
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
    select_lane,
)
from app.ui.timeline.layout import THIN, TimelineLayout, format_seconds
from app.ui.timeline.menus import TANGENT_MODES, TRACK_MENU, draw_key_menu, draw_track_menu
from app.ui.timeline.row import ChannelLane, LayerRow, find_least_gap, has_lanes
from app.ui.timeline.rows.sounds import draw_mute_button, draw_sound_background
from app.ui.timeline.rows.tracks import draw_track_range, format_track_name

RADIUS, GRIP = 0.4, 0.55  # em: half a key's diagonal, and half its hit box
EXPANDER_WIDTH = 1.1  # em: width of the triangle that folds lanes
INDENT = 1.4  # em: of a lane's name


def draw_expander(bands: TimelineLayout, row: LayerRow, left: float) -> list[Action]:
    """Draw the triangle that folds a layer's lanes, if the layer has any."""
    layer, em = row.layer, bands.look.em
    if not has_lanes(layer):
        return []
    half = THIN / 2 * em
    low = ImVec2(left, row.middle - half)
    high = ImVec2(left + EXPANDER_WIDTH * em, row.middle + half)
    clicked = bands.button(f"fold {layer.id}", low, high)
    is_open = layer.id in bands.project.timeline.expanded_layers
    draw_tooltip(_("Hide its channels") if is_open else _("Show its channels"))
    palette = bands.look.palette
    icon = icons.ICON_FA_CARET_DOWN if is_open else icons.ICON_FA_CARET_RIGHT
    top = row.middle - imgui.get_text_line_height() / 2
    colour = colour_u32(palette.text if is_hovered_or_held() else palette.dim)
    imgui.get_window_draw_list().add_text(ImVec2(left + 0.3 * em, top), colour, icon)
    return [do(timeline_drag.toggle_lanes, layer.id)] if clicked else []


def draw_lane_names(bands: TimelineLayout, lanes: Sequence[ChannelLane]) -> list[Action]:
    """Draw the names of lanes, and the on/off buttons of tracks."""
    actions: list[Action] = []
    for lane in filter(bands.shows_row, lanes):
        imgui.push_id(_id(lane))
        actions += _draw_name(bands, lane)
        imgui.pop_id()
    return actions


def _id(lane: ChannelLane) -> str:
    channel = lane.channel
    return f"lane {channel.kind.name} {channel.layer} {channel.part}"


def name_channel(layer: Layer | None, channel: Channel[Any], track: Track | None) -> str:
    """Return the name of a channel below its layer: of its handles, or of its kind."""
    if layer is not None and track is not None:
        return format_track_name(layer, track)
    name = str(channel.part) if channel.kind.of_sliders else _(channel.kind.label)
    if layer is None or not isinstance(channel.part, int):
        return name if channel.part is None else str(channel.part)
    return f"{name}: {layer.handle(channel.part).name}"


def _draw_name(bands: TimelineLayout, lane: ChannelLane) -> list[Action]:
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    layer, track = lane.layer, lane.track
    low = ImVec2(bands.corner.x, lane.top)
    high = ImVec2(bands.left - 0.3 * em, lane.bottom)
    actions: list[Action] = []
    if bands.button("name", low, high):
        actions += select_lane(lane.channel, {})
        if track is not None:
            actions.append(do(editing.select_handles, frozenset(track.handles)))
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        actions += select_lane(lane.channel, {})
        imgui.open_popup(TRACK_MENU)
    actions += draw_track_menu(bands)
    if lane.is_chosen or is_hovered_or_held():
        chosen = colour_u32(palette.accent, CHOSEN)
        colour = chosen if lane.is_chosen else colour_u32(palette.hovered)
        draw_list.add_rect_filled(low, high, colour, 0.2 * em)
    draw_tooltip(
        _("Click to select the track: then keys and drags of its handle go to the track")
        if track is not None
        else _("Click to select the channel: then new keys go to the channel")
    )
    is_on = track is None or track.enabled
    has_button = track is not None or lane.channel.kind is VOLUME
    room = high.x - low.x - (2.0 if has_button else 0.0) * em
    with push_text_size(SMALL):
        top = lane.middle - imgui.get_text_line_height() / 2
        text = shorten_text(name_channel(layer, lane.channel, track), room - 3.4 * em)
        place = ImVec2(low.x + INDENT * em, top)
        draw_list.add_text(place, colour_u32(palette.dim), _icon(lane))
        colour = colour_u32(palette.text if is_on else palette.dim)
        draw_list.add_text(ImVec2(place.x + 1.6 * em, top), colour, text)
    if lane.channel.kind is VOLUME:
        return actions + draw_mute_button(bands, lane, high)
    return actions + (_draw_switch(bands, lane, high, top) if track is not None else [])


def _icon(lane: ChannelLane) -> str:
    if lane.track is not None:
        return icons.ICON_FA_THUMBTACK if lane.track.is_scene_space else icons.ICON_FA_ROUTE
    return icon_glyph(lane.channel.kind.icon)


def _draw_switch(
    bands: TimelineLayout, lane: ChannelLane, high: ImVec2, top: float
) -> list[Action]:
    """Draw the button that switches a track on or off."""
    track, em, palette = lane.track, bands.look.em, bands.look.palette
    if track is None or lane.layer is None:
        return []
    switch = high.x - 2.0 * em
    clicked = bands.button("switch", ImVec2(switch, lane.top), high)
    draw_tooltip(
        _("Switch the track off: its keys stay") if track.enabled else _("Switch the track on")
    )
    icon = icons.ICON_FA_TOGGLE_ON if track.enabled else icons.ICON_FA_TOGGLE_OFF
    colour = colour_u32(palette.accent if track.enabled else palette.dim)
    with push_text_size(SMALL):
        imgui.get_window_draw_list().add_text(ImVec2(switch + 0.3 * em, top), colour, icon)
    handle, enabled = track.handles[0], not track.enabled
    command = track_commands.enable_track(lane.layer.id, handle, enabled=enabled)
    return [do(editing.edit_document, command)] if clicked else []


def draw_lane_backgrounds(bands: TimelineLayout, lanes: Sequence[ChannelLane]) -> None:
    """Draw the backgrounds of lanes, the ranges of their keys, and the values that hold."""
    palette, draw_list = bands.look.palette, imgui.get_window_draw_list()
    for lane in filter(bands.shows_row, lanes):
        low, high = ImVec2(bands.left, lane.top), ImVec2(bands.right, lane.bottom)
        draw_list.add_rect_filled(low, high, colour_u32(palette.desk, 0.45))
        if lane.is_chosen:
            draw_list.add_rect_filled(low, high, colour_u32(palette.accent, 0.16))
        draw_list.add_line(ImVec2(low.x, high.y), high, colour_u32(palette.line))
        if lane.layer is not None and lane.track is not None:
            draw_track_range(bands, lane, lane.layer, lane.track)
        elif lane.channel.kind is VOLUME:
            draw_sound_background(bands, lane)
        elif lane.channel.kind.is_held:
            _draw_held_values(bands, lane)
        else:
            _draw_key_range(bands, lane)


def _draw_key_range(bands: TimelineLayout, lane: ChannelLane) -> None:
    """Draw a line from the first to the last key of an interpolated channel."""
    keys = keys_in(bands.project.document, lane.channel)
    first, last = bands.x(keys[0].frame), bands.x(keys[-1].frame)
    imgui.get_window_draw_list().add_line(
        ImVec2(first, lane.middle),
        ImVec2(last, lane.middle),
        colour_u32(bands.look.palette.dim, 0.5),
        1.5,
    )


def _draw_held_values(bands: TimelineLayout, lane: ChannelLane) -> None:
    """Write the value that each key of a channel holds until the next key."""
    document, em = bands.project.document, bands.look.em
    keys = keys_in(document, lane.channel)
    for index in bands.in_view(keys):
        key = keys[index]
        left = bands.x(key.frame) + RADIUS * em
        is_last = index + 1 == len(keys)
        right = bands.right if is_last else bands.x(keys[index + 1].frame) - RADIUS * em
        with push_text_size(SMALL):
            text = shorten_text(label_value(document, lane.channel, key), right - left - 0.4 * em)
            top = lane.middle - imgui.get_text_line_height() / 2
            colour = colour_u32(bands.look.palette.dim)
            imgui.get_window_draw_list().add_text(ImVec2(left + 0.2 * em, top), colour, text)


def draw_lane_keys(bands: TimelineLayout) -> list[Action]:
    actions: list[Action] = []
    for lane in filter(bands.shows_row, bands.lanes):
        if lane.layer is not None:
            bands.push_track_clip()
        imgui.push_id(_id(lane))
        keys = keys_in(bands.project.document, lane.channel)
        for index in find_visible_keys(bands, lane.track, keys):
            actions += _key(bands, lane, keys[index])
        imgui.pop_id()
        if lane.layer is not None:
            imgui.pop_clip_rect()
    return actions


def find_visible_keys(
    bands: TimelineLayout, track: Track | None, keys: tuple[BaseKey, ...]
) -> list[int]:
    """Return the indices of the visible keys. In a loop, late keys of a track wrap around."""
    if track is None:
        return list(bands.in_view(keys))
    document, delay = bands.project.document, track.delay
    period = document.frames.last - document.frames.first
    shifts = {delay, delay - period * document.loop}
    return sorted({index for late in shifts for index in bands.in_view(keys, late=late)})


def _key(bands: TimelineLayout, lane: ChannelLane, key: BaseKey) -> list[Action]:
    em, gesture, channel = bands.look.em, bands.project.timeline.gesture, lane.channel
    gap = find_least_gap(bands.project.document, channel)
    room = max(0.48 * gap * bands.time_view.scale, 0.24)
    x, grip, radius = bands.x_of(channel, key.frame), GRIP * em, min(room, RADIUS) * em
    if not bands.shows(x - grip, x + grip):
        return []
    grip = min(grip, 1.4 * radius)
    low, high = ImVec2(x - grip, lane.middle - grip), ImVec2(x + grip, lane.middle + grip)
    bands.button(f"key {find_drag_origin(gesture, channel, key.frame)}", low, high, right=True)
    is_large = is_hovered_or_held() or is_key_dragged(gesture, channel, key.frame)
    _draw_key(bands, lane, key, ImVec2(x, lane.middle), (1.15 if is_large else 1.0) * radius)
    actions = begin_key_drag(bands, channel, key.frame)
    label_dragged_key(bands, channel, key.frame, x)
    if not isinstance(gesture, KeyDrag):
        _draw_tooltip(bands, lane, key)
    return actions + draw_key_menu(bands, channel, key)


def _draw_key(
    bands: TimelineLayout, lane: ChannelLane, key: BaseKey, centre: ImVec2, radius: float
) -> None:
    palette, em = bands.look.palette, bands.look.em
    tangent = TangentMode.HOLD if lane.channel.kind.is_held else key.shown_tangent_mode
    is_chosen = key.frame in bands.project.selection.keys.get(lane.channel, ())
    is_on = lane.track is None or lane.track.enabled
    colour = palette.text if is_on else palette.dim
    if is_chosen:
        draw_key_mark(tangent, centre, radius + 0.2 * em, colour_u32(palette.accent, 0.35))
    draw_key_mark(tangent, centre, radius + 0.1 * em, colour_u32(palette.desk))
    draw_key_mark(tangent, centre, radius, colour_u32(palette.accent if is_chosen else colour))


def _draw_tooltip(bands: TimelineLayout, lane: ChannelLane, key: BaseKey) -> None:
    if not begin_tooltip():
        return
    document, track, channel = bands.project.document, lane.track, lane.channel
    text = _("{channel}, frame {frame}")
    name = describe_channel(document, channel)
    imgui.text_unformatted(text.format(channel=name, frame=key.frame))
    imgui.same_line()
    imgui.text_disabled(format_seconds(key.frame, document.fps))
    if track is not None and track.delay:
        late = ngettext("{count} frame late, {time}", "{count} frames late, {time}", track.delay)
        time = format_seconds(track.delay, document.fps)
        imgui.text_disabled(late.format(count=track.delay, time=time))
    if track is None:
        imgui.text_unformatted(format_value(document, channel, key))
    if not channel.kind.is_held:
        mode, hint = TANGENT_MODES[key.shown_tangent_mode]
        imgui.text_unformatted(mode)
        imgui.text_disabled(hint)
    if isinstance(key, TrackKey) and key.velocity is not None:
        imgui.text_disabled(
            _("The key has its own velocity, until you choose a tangent or an easing")
        )
    imgui.text_disabled(KEY_GESTURES.format(gesture=format_modified(CTRL, _("drag"))))
    imgui.end_tooltip()
