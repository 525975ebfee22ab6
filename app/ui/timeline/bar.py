"""The bar above the tracks: transport, key buttons, frame numbers, and the interpolation method."""

from collections.abc import Callable

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.editor import Action, Project, Session, do
from app.editor.actions import playback, viewing
from app.editor.actions.timing import keys, timeline_drag
from app.editor.actions.tracking import recording
from app.editor.actions.tracking.recording import RECORDING_SPEEDS, set_recording_speed
from app.storage import LARGEST_GHOST_STEP, MOST_GHOSTS
from app.texts import _
from app.ui.bars.methods import draw_method_menu
from app.ui.methods import VARIANTS
from app.ui.shortcuts.keys import shown_keys
from app.ui.shortcuts.widgets import draw_action_button
from app.ui.style.theme import Look, colour_u32, icon_glyph
from app.ui.style.widgets import draw_tooltip, icon_button
from app.ui.timeline.layout import format_seconds
from app.ui.timeline.menus import draw_time_menu

GAP, TIGHT, WIDE = 0.35, 0.1, 1.1  # em: between related items, inside a group, between groups
FRAMES = 13.0  # em: width of the frame numbers
SLOWEST, FASTEST = 1.0, 240.0  # range of a drag, in frames per second
TRANSPORT = (
    *(playback.go_to_start, playback.PREVIOUS_FRAME, playback.toggle_play),
    *(playback.NEXT_FRAME, playback.go_to_end),
)


def draw_transport_bar(session: Session, look: Look, project: Project) -> list[Action]:
    actions = _transport(session, look, project)
    _gap(look)
    actions += _key_buttons(session, look, project)
    end = imgui.get_window_pos().x + imgui.get_window_width()
    if end - imgui.get_item_rect_max().x > FRAMES * look.em:
        _gap(look)
        actions += _frame(session, look, project)
    actions += _right(session, look, project)
    return actions


def _gap(look: Look) -> None:
    imgui.same_line(0, WIDE / 2 * look.em)
    corner = imgui.get_cursor_screen_pos()
    height = imgui.get_frame_height()
    imgui.get_window_draw_list().add_line(
        ImVec2(corner.x, corner.y + 0.25 * height),
        ImVec2(corner.x, corner.y + 0.75 * height),
        colour_u32(look.palette.line),
    )
    imgui.dummy(ImVec2(1, height))
    imgui.same_line(0, WIDE / 2 * look.em)


def _transport(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    is_playing = project.timeline.playhead.since is not None
    for spec in TRANSPORT:
        icon = "PAUSE" if spec is playback.toggle_play and is_playing else ""
        actions += draw_action_button(session, look, spec, icon)
        imgui.same_line(0, TIGHT * look.em)
    actions += draw_action_button(session, look, keys.toggle_loop)
    imgui.same_line(0, TIGHT * look.em)
    actions += draw_action_button(session, look, recording.toggle_recording_armed)
    imgui.same_line(0, TIGHT * look.em)
    return actions + _recording_speed(session, look)


def _recording_speed(session: Session, look: Look) -> list[Action]:
    actions: list[Action] = []
    imgui.set_next_item_width(4.6 * look.em)
    if imgui.begin_combo("##recording", f"{session.tools.recording_speed:.0%}"):
        actions += [
            do(set_recording_speed, speed)
            for speed in RECORDING_SPEEDS
            if imgui.selectable(f"{speed:.0%}", speed == session.tools.recording_speed)[0]
        ]
        imgui.end_combo()
    draw_tooltip(_("Speed of the timeline while a drag is recorded"))
    return actions


def _key_buttons(session: Session, look: Look, project: Project) -> list[Action]:
    actions = draw_action_button(session, look, playback.PREVIOUS_KEY)
    imgui.same_line(0, TIGHT * look.em)
    actions += draw_action_button(session, look, keys.insert_key_in_row)
    if project.unkeyed_pose is not None:
        high = imgui.get_item_rect_max()
        imgui.get_window_draw_list().add_circle_filled(
            ImVec2(high.x - 0.4 * look.em, high.y - 1.3 * look.em),
            0.22 * look.em,
            colour_u32(look.palette.warning),
        )
    imgui.same_line(0, TIGHT * look.em)
    actions += draw_action_button(session, look, playback.NEXT_KEY)
    imgui.same_line(0, TIGHT * look.em)
    actions += draw_action_button(session, look, viewing.toggle_auto_key)
    imgui.same_line(0, TIGHT * look.em)
    if icon_button(look, icons.ICON_FA_ELLIPSIS, "more", _("Reverse, scale time, preview range")):
        imgui.open_popup("menu of time")
    return actions + draw_time_menu(session, look, project)


def _frame(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    document = project.document
    frame = playback.current_frame(session, project)
    imgui.set_next_item_width(3.8 * look.em)
    changed, wanted = imgui.drag_int(
        "##frame", frame, 0.2, document.frames.first, document.frames.last
    )
    draw_tooltip(_("Current frame: drag, or click to type"))
    if changed:
        actions.append(do(playback.scrub, wanted))
    imgui.same_line(0, GAP * look.em)
    imgui.text_disabled(_("of"))
    imgui.same_line(0, GAP * look.em)
    imgui.set_next_item_width(3.8 * look.em)
    flags = imgui.InputTextFlags_.enter_returns_true
    changed, last = imgui.input_int("##last", document.frames.last, 0, 0, flags)
    draw_tooltip(_("Last frame: type it, or drag the end on the ruler"))
    if changed:
        actions.append(do(keys.set_last_frame, last))
    imgui.same_line(0, 0.8 * look.em)
    imgui.text_disabled(format_seconds(frame, document.fps))
    return actions


def _right(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the items at the right that fit. The last of them has priority."""
    em, square = look.em, 1.15 * imgui.get_frame_height()
    parts: list[tuple[float, Callable[[], list[Action]]]] = [
        (8.0 * em, lambda: _variant(project)),
        (square, lambda: _onion_skin(session, look)),
        (4.4 * em, lambda: _speed(project)),
        (5.2 * em, lambda: _fps(project)),
        (square, lambda: draw_action_button(session, look, timeline_drag.fit_timeline)),
    ]
    imgui.same_line(0, WIDE * em)
    begin = imgui.get_cursor_pos_x()
    end = imgui.get_window_width() - imgui.get_style().window_padding.x
    while parts and begin + _width(look, parts) > end:
        del parts[0]
    imgui.set_cursor_pos_x(max(begin, end - _width(look, parts)))
    actions: list[Action] = []
    for index, (width, draw) in enumerate(parts):
        if index:
            imgui.same_line(0, GAP * em)
        imgui.set_next_item_width(width)
        actions += draw()
    if not parts:
        imgui.new_line()
    return actions


def _width(look: Look, parts: list[tuple[float, Callable[[], list[Action]]]]) -> float:
    return sum(width for width, _ in parts) + max(len(parts) - 1, 0) * GAP * look.em


def _fps(project: Project) -> list[Action]:
    fps = project.document.fps
    changed, wanted = imgui.drag_float("##fps", fps, 0.1, SLOWEST, FASTEST, "%.4g fps")
    draw_tooltip(_("Frames per second: drag, or click to type"))
    return [do(keys.set_fps, round(wanted, 3))] if changed else []


def _speed(project: Project) -> list[Action]:
    actions: list[Action] = []
    current = project.timeline.playhead.speed
    if imgui.begin_combo("##speed", f"{current:g}×"):
        actions += [
            do(playback.set_playback_speed, speed)
            for speed in playback.SPEEDS
            if imgui.selectable(f"{speed:g}×", speed == current)[0]
        ]
        imgui.end_combo()
    draw_tooltip(_("Playback speed. The animation itself does not change."))
    return actions


def _onion_skin(session: Session, look: Look) -> list[Action]:
    actions: list[Action] = []
    overlays, preferences = session.display.overlays, session.settings.preferences
    spec = viewing.ONION_SKIN
    hint = _("Onion skin: the poses shown before and after this frame")
    if icon_button(look, icon_glyph(spec.icon), "onion skin", hint, active=overlays.onion):
        imgui.open_popup("menu of onion skin")
    if not imgui.begin_popup("menu of onion skin"):
        return actions
    if imgui.checkbox(spec.label, overlays.onion)[0]:
        actions.append(spec.action)
    imgui.same_line()
    imgui.text_disabled(shown_keys(spec))
    values = [preferences.ghosts_before, preferences.ghosts_after, preferences.ghost_step]
    before = list(values)
    sliders = (
        *((_("before"), 0, MOST_GHOSTS), (_("after"), 0, MOST_GHOSTS)),
        (_("frames apart"), 1, LARGEST_GHOST_STEP),
    )
    for index, (name, low, high) in enumerate(sliders):
        imgui.set_next_item_width(8 * look.em)
        values[index] = imgui.slider_int(name, values[index], low, high)[1]
    if values != before:
        actions.append(do(viewing.set_onion_skin, *values))
    changed, in_front = imgui.checkbox(_("Draw in front"), preferences.ghosts_in_front)
    draw_tooltip(_("Draw the onion skin in front of all layers, not behind the posed layers"))
    if changed:
        actions.append(do(viewing.set_onion_skin_in_front, in_front))
    imgui.end_popup()
    return actions


def _variant(project: Project) -> list[Action]:
    actions: list[Action] = []
    if imgui.begin_combo("##variant", VARIANTS[project.layer.variant].name):
        actions += draw_method_menu(project)
        imgui.end_combo()
    draw_tooltip(_("Method for the in-betweens"))
    return actions
