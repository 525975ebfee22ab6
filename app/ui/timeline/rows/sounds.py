"""Lanes of sounds: their waveforms, which are dragged in time and cut at both ends."""

from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import Sound, sound_commands
from app.editor import Action, SoundDrag, do
from app.editor.actions import editing, viewing
from app.editor.actions.timing import sounds, timeline_drag
from app.sound import PEAKS_PER_SECOND
from app.texts import _
from app.ui.style.theme import SMALL, colour_u32
from app.ui.style.widgets import (
    begin_tooltip,
    is_hovered_or_held,
    is_pressed,
    push_text_size,
    shorten_text,
)
from app.ui.timeline.layout import TimelineLayout, draw_time_tag, format_seconds
from app.ui.timeline.row import ChannelLane

GRIP = 0.45  # em: width of the ends that cut
COLUMN = 2.0  # pixels of the waveform
SoundPart = Literal["whole", "begin", "end"]


def sound_of_lane(bands: TimelineLayout, lane: ChannelLane) -> Sound:
    return bands.project.document.sound(str(lane.channel.part))


def draw_sound_background(bands: TimelineLayout, lane: ChannelLane) -> None:
    """Draw the part of a sound that is heard, with its waveform."""
    sound, fps = sound_of_lane(bands, lane), bands.project.document.fps
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    left, right = bands.x(sound.start), max(bands.x(sound.end(fps)), bands.x(sound.start) + 2)
    low, high = ImVec2(left, lane.top + 1), ImVec2(right, lane.bottom - 1)
    draw_list.push_clip_rect(
        ImVec2(bands.left, lane.top),
        ImVec2(bands.right, lane.bottom),
        True,  # noqa: FBT003
    )
    is_missing = sound.file.data is None
    colour = palette.danger if is_missing else palette.dim if sound.muted else palette.accent
    draw_list.add_rect_filled(low, high, colour_u32(colour, 0.22), 0.25 * em)
    draw_list.add_rect(low, high, colour_u32(colour, 0.7), 0.25 * em)
    begin, end = max(left, bands.left), min(right, bands.right)
    columns = np.arange(begin, end, COLUMN)
    levels = _levels(bands, sound, columns)
    half = (lane.bottom - lane.top) / 2 - 2
    wave = colour_u32(colour, 0.9)
    for x, level in zip(columns.tolist(), (half * levels).tolist(), strict=True):
        draw_list.add_line(ImVec2(x, lane.middle - level), ImVec2(x, lane.middle + level), wave)
    if is_missing:
        with push_text_size(SMALL):
            text = _("{file} is missing: right-click to find it").format(file=sound.file.name)
            top = lane.middle - imgui.get_text_line_height() / 2
            shown = shorten_text(text, end - begin - em)
            draw_list.add_text(ImVec2(begin + 0.5 * em, top), colour_u32(palette.text), shown)
    draw_list.pop_clip_rect()


def _levels(
    bands: TimelineLayout, sound: Sound, columns: npt.NDArray[Any]
) -> npt.NDArray[np.float64]:
    """Return the largest levels in columns of pixels, from 0 to 1, with the volume."""
    found = bands.project.measured.waveforms.get(sound.file.sha256)
    if found is None or not len(columns):
        return np.zeros(len(columns))
    per_frame, document = bands.look.em * bands.time_view.scale, bands.project.document
    frames = bands.frame(0) + columns / per_frame
    seconds = (frames - sound.start) / document.fps + sound.skip
    edges = np.clip(np.rint(seconds * PEAKS_PER_SECOND), 0, len(found.peaks) - 1).astype(int)
    levels = np.maximum.reduceat(found.peaks, edges) / 255
    volume: Any = sound.volume
    if sound.keys:
        keyed = [key.frame for key in sound.keys], [key.value for key in sound.keys]
        volume = np.interp(frames, *keyed)
    return np.asarray(levels * volume)


def draw_sound_lanes(bands: TimelineLayout) -> list[Action]:
    """Handle the pointer on sounds: drags in time, cuts, and their menus."""
    actions: list[Action] = []
    for lane in bands.sound_lanes:
        imgui.push_id(f"sound {lane.channel.part}")
        actions += _lane(bands, lane)
        imgui.pop_id()
    return actions


def _lane(bands: TimelineLayout, lane: ChannelLane) -> list[Action]:
    sound, fps, em = sound_of_lane(bands, lane), bands.project.document.fps, bands.look.em
    left, right = bands.x(sound.start), bands.x(sound.end(fps))
    if not bands.shows(left, right):
        return []
    grip = min(GRIP * em, (right - left) / 3)
    parts: tuple[tuple[SoundPart, float, float], ...] = (
        ("whole", left + grip, right - grip),
        ("begin", left, left + grip),
        ("end", right - grip, right),
    )
    actions: list[Action] = []
    for part, begin, end in parts:
        low, high = (
            ImVec2(max(begin, bands.left), lane.top),
            ImVec2(min(end, bands.right), lane.bottom),
        )
        if low.x >= high.x:
            continue
        bands.button(part, low, high, right=True)
        if is_hovered_or_held():
            cursor = imgui.MouseCursor_.hand if part == "whole" else imgui.MouseCursor_.resize_ew
            imgui.set_mouse_cursor(cursor)
        if is_pressed():
            drag = SoundDrag(start=bands.pointed, sound=sound.name, part=part)
            actions += [
                do(sounds.select_sound, sound.name),
                do(timeline_drag.begin_timeline_drag, drag, bands.time_view),
            ]
        if imgui.is_item_clicked(imgui.MouseButton_.right):
            actions.append(do(sounds.select_sound, sound.name))
            imgui.open_popup("menu of sound")
        if bands.project.timeline.gesture is None:
            _tooltip(bands, sound)
    gesture = bands.project.timeline.gesture
    if isinstance(gesture, SoundDrag) and gesture.sound == sound.name:
        at = sound.end(fps) if gesture.part == "end" else sound.start
        draw_time_tag(bands, bands.x(at), f"{at:.4g}  {format_seconds(at, fps)}")
    return actions + _menu(sound)


def _tooltip(bands: TimelineLayout, sound: Sound) -> None:
    if not begin_tooltip():
        return
    fps = bands.project.document.fps
    imgui.text_unformatted(sound.name)
    imgui.same_line()
    imgui.text_disabled(f"{sound.file.name}, {sound.length:.2f} s")
    text = _("Frames {first:.4g} to {last:.4g}, from {time}")
    known = {"first": sound.start, "last": sound.end(fps), "time": format_seconds(sound.start, fps)}
    imgui.text_unformatted(text.format(**known))
    imgui.text_disabled(_("Drag to move it, drag an end to cut it, right-click for more"))
    imgui.end_tooltip()


def _menu(sound: Sound) -> list[Action]:
    actions: list[Action] = []
    if imgui.begin_popup("menu of sound"):
        if imgui.menu_item_simple(_("Unmute") if sound.muted else _("Mute")):
            command = sound_commands.mute_sound(sound.name, muted=not sound.muted)
            actions.append(do(editing.edit_document, command))
        if imgui.menu_item_simple(_("Sound settings")):
            actions.append(do(viewing.show_tab, "Sound"))
        if imgui.menu_item_simple(_("Find file…")):
            actions.append(do(sounds.ask_sound_file, sound.name))
        imgui.separator()
        if imgui.menu_item_simple(_("Delete")):
            actions.append(do(editing.edit_document, sound_commands.delete_sound(sound.name)))
        imgui.end_popup()
    return actions


def draw_mute_button(bands: TimelineLayout, lane: ChannelLane, high: ImVec2) -> list[Action]:
    """Draw the button beside a sound's name that mutes it."""
    sound, em, palette = sound_of_lane(bands, lane), bands.look.em, bands.look.palette
    left = high.x - 2.0 * em
    clicked = bands.button("mute", ImVec2(left, lane.top), high)
    if begin_tooltip():
        imgui.text_unformatted(_("Unmute the sound") if sound.muted else _("Mute the sound"))
        imgui.end_tooltip()
    icon = icons.ICON_FA_VOLUME_XMARK if sound.muted else icons.ICON_FA_VOLUME_HIGH
    colour = colour_u32(palette.dim if sound.muted else palette.accent)
    with push_text_size(SMALL):
        top = lane.middle - imgui.get_text_line_height() / 2
        imgui.get_window_draw_list().add_text(ImVec2(left + 0.3 * em, top), colour, icon)
    command = sound_commands.mute_sound(sound.name, muted=not sound.muted)
    return [do(editing.edit_document, command)] if clicked else []
