"""Menus of keys, tracks and the timeline."""

from typing import Any

from imgui_bundle import imgui

from app.document import (
    PRESETS,
    TRACK,
    BaseKey,
    Channel,
    Key,
    KeysByChannel,
    TangentMode,
    channel_commands,
    display_frame,
    frames_in,
    key_commands,
    track_commands,
    track_in,
)
from app.editor import Action, Project, Session, do
from app.editor.actions import editing, playback
from app.editor.actions.timing import cycles, keys, tracks
from app.editor.poses import copying, pasting
from app.texts import _, ngettext
from app.ui.shortcuts.keys import shown_keys
from app.ui.shortcuts.widgets import draw_action_item
from app.ui.style.theme import Look
from app.ui.style.widgets import draw_tooltip, menu_entry, shorten_text
from app.ui.timeline.easing_curve import LABELS
from app.ui.timeline.layout import TimelineLayout
from app.ui.timeline.value_fields import draw_value_fields

TANGENT_MODES = {
    TangentMode.SMOOTH: (_("Smooth"), _("The motion goes on smoothly, between two other keys")),
    TangentMode.CORNER: (_("Corner"), _("The motion is straight on both sides, and turns sharply")),
    TangentMode.STOP: (_("Stop"), _("The motion slows down to rest, and starts again")),
    TangentMode.HOLD: (_("Hold"), _("The pose stays until the next key")),
}
TRACK_MENU = "menu of track"
NAME = 9.0  # em: largest width of a layer's name
FACTORS = ((0.5, _("Half as long")), (2.0, _("Twice as long")))


def draw_key_menu(bands: TimelineLayout, channel: Channel[Any], key: BaseKey) -> list[Action]:
    """Draw the menu of a channel's key, if it is open."""
    actions: list[Action] = []
    if not imgui.begin_popup(f"menu of key {key.frame}"):
        return actions
    project = bands.project
    taken = project.selection.keys_with(channel, key.frame)
    count = sum(map(len, taken.values()))
    delete = editing.delete_selection
    text = ngettext("Delete", "Delete {count} keys", count).format(count=count)
    if imgui.menu_item_simple(f"{text}###Delete", shown_keys(delete)):
        actions.append(delete.action)
    text = ngettext("Copy", "Copy {count} keys", count).format(count=count)
    if imgui.menu_item_simple(f"{text}###Copy", shown_keys(copying.copy_pose_or_keys)):
        actions.append(do(copying.copy_keys))
    seen = display_frame(project.document, channel, key.frame)
    actions += _paste_items(bands.session, seen)
    imgui.separator()
    if imgui.menu_item_simple(_("Go to this key"), _("Click")):
        actions.append(do(playback.scrub, seen))
    if isinstance(key, Key):
        actions += draw_value_fields(bands.look, channel, key)
    if not channel.kind.is_held:
        actions += _motion_items(key, taken)
    actions += _cycle_items(bands, key.frame)
    imgui.separator()
    actions += draw_time_items(bands.session, bands.look, project)
    imgui.end_popup()
    return actions


def _motion_items(key: BaseKey, taken: KeysByChannel) -> list[Action]:
    """Draw the tangent modes and easings of keys that are interpolated."""
    actions: list[Action] = []
    if imgui.begin_menu(_("Tangent")):
        for tangent, (name, hint) in TANGENT_MODES.items():
            chosen = key.shown_tangent_mode is tangent
            if imgui.menu_item(f"{name}###{tangent}", "", chosen)[0]:
                actions.append(
                    do(editing.edit_document, channel_commands.set_tangent_mode(taken, tangent))
                )
            draw_tooltip(hint)
        imgui.end_menu()
    if imgui.begin_menu(_("Easing")):
        for name, preset in PRESETS.items():
            if imgui.menu_item(LABELS[name], "", key.easing == preset)[0]:
                actions.append(do(keys.set_easing, taken, preset))
        imgui.end_menu()
    return actions


def _paste_items(session: Session, frame: int) -> list[Action]:
    """Draw the paste entries for a frame. A paste moves the playhead there."""
    pasted = [
        action
        for spec in (pasting.PASTE, pasting.PASTE_SWAPPED, pasting.PASTE_FLIPPED)
        for action in draw_action_item(session, spec)
    ]
    return [do(playback.scrub, frame), *pasted] if pasted else []


def draw_track_menu(bands: TimelineLayout) -> list[Action]:
    """Draw the menu of the empty area between keys, or of a channel's name, if it is open."""
    actions: list[Action] = []
    if not imgui.begin_popup(TRACK_MENU):
        return actions
    opened = imgui.get_mouse_pos_on_opening_current_popup()
    frame = bands.project.document.frames.clamp(round(bands.frame(opened.x)))
    if opened.x < bands.left:
        frame = playback.current_frame(bands.session, bands.project)
    text = _("Insert key at frame {frame}").format(frame=frame)
    if imgui.menu_item_simple(f"{text}###Insert key"):
        actions.append(do(keys.insert_key_in_row_at, frame))
    track = track_in(bands.project.document, bands.project.channel)
    if track is not None and not track.is_scene_space:
        if imgui.menu_item_simple(_("Back to body pose") + "###Insert in pose"):
            actions += [
                do(playback.scrub, frame),
                do(tracks.set_handle_value, track.handles[0], 0j, 0.0),
            ]
        draw_tooltip(
            _("Key the handle where the pose has it, so that the track begins or ends smoothly")
        )
    actions += _paste_items(bands.session, frame)
    text = _("Add marker at frame {frame}").format(frame=frame)
    if imgui.menu_item_simple(f"{text}###Add marker"):
        actions.append(do(keys.add_marker, frame))
    actions += _cycle_items(bands, frame)
    imgui.separator()
    actions += draw_time_items(bands.session, bands.look, bands.project)
    if track is not None:
        imgui.separator()
        if imgui.menu_item_simple(_("Delete track")):
            actions.append(do(editing.edit_layer, track_commands.remove_tracks, track.handles[:1]))
    imgui.end_popup()
    return actions


def _cycle_items(bands: TimelineLayout, frame: int) -> list[Action]:
    actions: list[Action] = []
    cycle = cycles.cycle_at_playhead(bands.session, bands.project, frame)
    if cycle is None or bands.project.channel.kind is TRACK:
        return actions
    imgui.separator()
    if imgui.menu_item_simple(_("Bake repeats")):
        actions.append(do(cycles.bake_cycle, frame))
    draw_tooltip(
        _("Turn the repeats of frames {first} to {last} into keys that you can edit").format(
            first=cycle.first, last=cycle.last
        )
    )
    if imgui.menu_item_simple(_("Stop repeating")):
        actions.append(do(cycles.end_cycle, frame))
    return actions


def draw_time_items(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the entries of the open menu that change the time of keys, and the preview range."""
    actions: list[Action] = []
    actions += draw_action_item(session, cycles.create_cycle)
    count, chosen = len(frames_in(project.document, project.channel)), project.selection.key_count
    # Scaling changes the whole scene, reversing only the active layer.
    reverse, scale = _("Reverse all keys"), _("Scale time of all keys")
    if chosen > 1:
        reverse = ngettext("Reverse {count} key", "Reverse {count} keys", chosen)
        scale = ngettext("Scale time of {count} key", "Scale time of {count} keys", chosen)
    elif len(project.document.layers) > 1:
        reverse = _("Reverse all keys of {layer}")
    name = shorten_text(project.layer.name, NAME * look.em)
    reverse, scale = (text.format(count=chosen, layer=name) for text in (reverse, scale))
    second = _("Set a second key first.")
    reason = None if max(count, chosen) > 1 else second
    if menu_entry(f"{reverse}###Reverse", reason=reason):
        actions.append(do(keys.reverse_selected_keys))
    if imgui.begin_menu(f"{scale}###Scale time"):
        actions += [
            do(keys.scale_selected_keys, factor)
            for factor, text in FACTORS
            if imgui.menu_item_simple(text)
        ]
        imgui.set_next_item_width(5 * look.em)
        entered, percent = imgui.input_float(
            _("of its length") + "###percent",
            100.0,
            0,
            0,
            "%.4g %%",
            imgui.InputTextFlags_.enter_returns_true,
        )
        if entered:
            actions.append(do(keys.scale_selected_keys, percent / 100))
            imgui.close_current_popup()
        imgui.end_menu()
    reason = None if len(project.layer.keys) > 1 else second
    if menu_entry(_("Copy first pose to last key"), reason=reason):
        actions.append(do(editing.edit_layer, key_commands.match_loop_ends))
    imgui.separator()
    for spec in (
        keys.start_preview_at_playhead,
        keys.end_preview_at_playhead,
        keys.clear_preview_range,
    ):
        actions += draw_action_item(session, spec)
    return actions
