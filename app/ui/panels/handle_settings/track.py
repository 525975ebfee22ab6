"""The track of a handle: its own keys, in addition to pose keys."""

import math
from dataclasses import replace

from imgui_bundle import icons_fontawesome_6 as icons, imgui

from app.document import Handle, Track, mirrored_handles, misses_target, track_at, track_commands
from app.editor import Action, Project, Session, do
from app.editor.actions import editing, playback
from app.editor.actions.timing import tracks
from app.texts import _
from app.ui.style.sliders import Scale, number_field, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    align_right,
    draw_tooltip,
    heading,
    icon_button,
    label,
    option_buttons,
    small_text,
    split_line,
    text_button,
)

REACHES = Scale(left=0.0, right=1.0)
LONGEST = 48  # frames: the longest delay on the slider if the animation does not loop
KINDS = (("pose", _("With the pose")), ("picture", _("Planted")))


def draw_track(session: Session, look: Look, project: Project, handle: Handle) -> list[Action]:
    track = project.layer.track_of(handle.id)
    if track is None:
        return []
    heading(look, _("Own track"), framed=True)
    align_right(1.15 * imgui.get_frame_height())
    actions: list[Action] = []
    hint = _("Delete the track: the handle moves with the whole pose again")
    if icon_button(look, icons.ICON_FA_TRASH, "delete track", hint):
        command = track_commands.remove_tracks
        actions.append(do(editing.edit_layer, command, (handle.id,)))
    _together(look, project, track)
    actions += _here(session, look, project, track)
    actions += _kind(look, project, handle, track) + _numbers(look, project, handle, track)
    actions += _copies(project, handle)
    _out_of_reach(session, look, project, handle)
    return actions


def _together(look: Look, project: Project, track: Track) -> None:
    if len(track.handles) > 1:
        names = ", ".join(project.layer.handle(identity).name for identity in track.handles)
        small_text(look, _("This track moves {names} together.").format(names=names))


def _here(session: Session, look: Look, project: Project, track: Track) -> list[Action]:
    """Draw the track's value at the present frame. An entered value becomes a key."""
    actions: list[Action] = []
    frame = playback.current_frame(session, project)
    at = track_at(replace(track, enabled=True), project.clip, frame)
    if at is None:
        small_text(
            look, _("At this frame the track does not act. It acts from its first to its last key.")
        )
        return actions
    first, height = track.handles[0], project.document.canvas[1] if track.is_scene_space else 0.0
    name = _("Place") if track.is_scene_space else _("Offset")
    hint = (
        _("Target at this frame, in pixels from the upper left corner. Typing sets a key.")
        if track.is_scene_space
        else _("Offset from the pose at this frame, in pixels right and down. Typing sets a key.")
    )
    label(look, name)
    entered = []
    widths = split_line(2, imgui.get_style().item_inner_spacing.x)
    for axis, value, width in zip(
        "xy", (at.place.real, height - at.place.imag), widths, strict=True
    ):
        imgui.set_next_item_width(width)
        entered.append(number_field(f"track {axis}", value, "%.1f"))
        draw_tooltip(hint)
    x, y = entered
    if x is not None or y is not None:
        place = complex(
            at.place.real if x is None else x, at.place.imag if y is None else height - y
        )
        actions.append(do(tracks.set_handle_value, first, place))
    if track.keys_rotation:
        label(look, _("Turn"))
        turn = number_field("track turn", math.degrees(at.turn), "%.1f°")
        draw_tooltip(_("Turn added to the pose, counter-clockwise. Typing sets a key."))
        if turn is not None:
            actions.append(do(tracks.set_handle_value, first, at.place, math.radians(turn)))
    return actions


def _kind(look: Look, project: Project, handle: Handle, track: Track) -> list[Action]:
    """Draw whether a track is on, the space of its keys, and whether they rotate the shape."""
    actions: list[Action] = []
    label(look, _("Keys are"))
    kind = option_buttons(look, "kind", KINDS, "picture" if track.is_scene_space else "pose")
    draw_tooltip(
        _("Offsets from the pose, or fixed places in the picture, such as a foot on the ground")
    )
    if kind is not None:
        actions.append(do(tracks.set_track_space, handle.id, kind == "picture"))
    label(look, _("Track"))
    changed, enabled = imgui.checkbox(_("on") + "##track", track.enabled)
    draw_tooltip(_("Switch the track on or off. Its keys stay."))
    if changed:
        command = track_commands.enable_track(project.selection.active, handle.id, enabled=enabled)
        actions.append(do(editing.edit_document, command))
    imgui.same_line()
    changed, turns = imgui.checkbox(_("Key rotation"), track.keys_rotation)
    draw_tooltip(_("Let the keys turn the shape at the handle. Otherwise it turns freely."))
    if changed:
        command = track_commands.set_turning(project.selection.active, handle.id, turns=turns)
        actions.append(do(editing.edit_document, command))
    return actions


def _numbers(look: Look, project: Project, handle: Handle, track: Track) -> list[Action]:
    actions: list[Action] = []
    frames = project.document.frames
    longest = frames.last - frames.first if project.document.loop else LONGEST
    label(look, _("Delay"))
    hint = _("Delay of the track in frames. In a loop, the end continues at the beginning.")
    scale = Scale(left=0.0, right=float(max(longest, 1)))
    entered = slider(look, "delay", float(track.delay), scale, text="%.0f", hint=hint)
    if entered is not None:
        delay = round(scale.clamp(entered.value) if project.document.loop else entered.value)
        actions.append(do(editing.edit_layer, track_commands.set_delay, handle.id, delay))
    label(look, _("Reach"))
    hint = _("How far around the handle the shape bends: 0 hardly, 1 freely")
    entered = slider(look, "reach", track.reach, REACHES, hint=hint)
    if entered is not None:
        reach = round(REACHES.clamp(entered.value), 2)
        actions.append(do(editing.edit_layer, track_commands.set_reach, handle.id, reach))
    return actions


def _copies(project: Project, handle: Handle) -> list[Action]:
    """Draw the menu that copies the track to another handle, and the button that mirrors it."""
    actions: list[Action] = []
    widths, layer = split_line(2), project.layer
    imgui.set_next_item_width(next(widths))
    if imgui.begin_combo("##copy track", _("Copy to…")):
        for other in layer.handles:
            if other.id == handle.id:
                continue
            has_track = layer.track_of(other.id) is not None
            text = _("{name}  (has a track)").format(name=other.name) if has_track else other.name
            if imgui.menu_item_simple(f"{text}###copy to {other.id}"):
                command = track_commands.copy_track
                actions.append(do(editing.edit_layer, command, handle.id, other.id))
        imgui.end_combo()
    draw_tooltip(_("Copy this track to another handle and replace its track"))
    words = project.document.pairs
    partners = mirrored_handles(layer.handles, layer.axis, layer.domain.outline, words)
    is_pair = partners.get(handle.id, handle.id) != handle.id
    hint = (
        _("Copy this track, mirrored, to the partner on the other side")
        if is_pair
        else _("No partner was found on the other side by name or place")
    )
    if text_button(_("Mirror track") if not is_pair else _("Copy mirrored"), next(widths), hint):
        actions.append(do(editing.edit_layer, track_commands.mirror_track, handle.id, words))
    return actions


def _out_of_reach(session: Session, look: Look, project: Project, handle: Handle) -> None:
    """Report the target error of the handle's track at the present frame, if any."""
    frame, corrected = playback.current_frame(session, project), project.layer_runtime.corrected
    miss = corrected.misses.get(frame, {}).get(handle.id, 0.0) if corrected else 0.0
    if misses_target(project.layer, miss):
        text = _("{miss:.0f} px short of its track at this frame.").format(miss=miss)
        small_text(look, text, look.palette.danger)
