"""The bar above the tracks: transport, keys, frame and fps; the rest is behind its last button."""

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.editor import Action, Project, Session, do
from app.editor.actions import playback, viewing
from app.editor.actions.timing import graph, keys, timeline_drag
from app.editor.actions.tracking import recording
from app.editor.actions.tracking.recording import RECORDING_SPEEDS, set_recording_speed
from app.texts import _
from app.ui.shortcuts.widgets import draw_action_button, draw_action_item
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import draw_tooltip, icon_button
from app.ui.timeline.layout import format_seconds
from app.ui.timeline.menus import draw_time_items

GAP, TIGHT, WIDE = 0.35, 0.1, 1.1  # em: between related items, inside a group, between groups
SLOWEST, FASTEST = 1.0, 240.0  # range of a drag, in frames per second
TRANSPORT = (playback.go_to_start, playback.toggle_play, playback.go_to_end)
RUNNING = (keys.toggle_loop, recording.toggle_recording_armed)
STEPS = (
    *(playback.PREVIOUS_FRAME, playback.NEXT_FRAME),
    *(playback.PREVIOUS_KEY, playback.NEXT_KEY),
)
FIELD, LEAST_TIME = 3.8, 6.0  # em: width of a number, room for the time in seconds


def draw_transport_bar(session: Session, look: Look, project: Project) -> list[Action]:
    actions = _transport(session, look, project)
    _gap(look)
    actions += _key_buttons(session, look, project)
    _gap(look)
    actions += _frame(session, look, project)
    return actions + _more(session, look, project)


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
    for spec in RUNNING:
        actions += draw_action_button(session, look, spec)
        imgui.same_line(0, TIGHT * look.em)
    return actions


def _key_buttons(session: Session, look: Look, project: Project) -> list[Action]:
    actions = draw_action_button(session, look, keys.insert_key_in_row)
    if project.unkeyed_pose is not None:
        high = imgui.get_item_rect_max()
        imgui.get_window_draw_list().add_circle_filled(
            ImVec2(high.x - 0.4 * look.em, high.y - 1.3 * look.em),
            0.22 * look.em,
            colour_u32(look.palette.warning),
        )
    imgui.same_line(0, TIGHT * look.em)
    return actions + draw_action_button(session, look, viewing.toggle_auto_key)


def _frame(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the frame at the playhead, the last frame and the time, and the frames per second."""
    actions: list[Action] = []
    document = project.document
    frame = playback.current_frame(session, project)
    imgui.set_next_item_width(FIELD * look.em)
    first, last = document.frames.first, document.frames.last
    changed, wanted = imgui.drag_int("##frame", frame, 0.2, first, last)
    draw_tooltip(_("Current frame: drag, or click to type"))
    if changed:
        actions.append(do(playback.scrub, wanted))
    imgui.same_line(0, GAP * look.em)
    imgui.text_disabled(_("of {last}").format(last=last))
    imgui.same_line(0, GAP * look.em)
    room = imgui.get_content_region_avail().x
    if room > (LEAST_TIME + 2 * FIELD + 2) * look.em:
        imgui.same_line(0, 0.8 * look.em)
        imgui.text_disabled(format_seconds(frame, document.fps))
        imgui.same_line(0, 0.8 * look.em)
    return actions


def _more(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the frames per second and the menu of the rest, at the end of the line."""
    em, width = look.em, 5.2 * look.em
    square = 1.15 * imgui.get_frame_height()
    end = imgui.get_window_width() - imgui.get_style().window_padding.x
    place = end - width - GAP * em - square
    imgui.set_cursor_pos_x(max(imgui.get_cursor_pos_x(), place))
    imgui.set_next_item_width(width)
    actions = _fps(project)
    imgui.same_line(0, GAP * em)
    if icon_button(look, icons.ICON_FA_ELLIPSIS, "more", _("More of the timeline")):
        imgui.open_popup("menu of time")
    if imgui.begin_popup("menu of time"):
        actions += _more_items(session, look, project)
        imgui.end_popup()
    return actions


def _more_items(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    for spec in STEPS:
        actions += draw_action_item(session, spec)
    imgui.separator()
    imgui.set_next_item_width(5 * look.em)
    flags = imgui.InputTextFlags_.enter_returns_true
    last_frame = project.document.frames.last
    changed, last = imgui.input_int(f"{_('Last frame')}###last", last_frame, 0, 0, flags)
    draw_tooltip(_("Type it, or drag the end on the ruler"))
    if changed:
        actions.append(do(keys.set_last_frame, last))
    actions += _speed(project) + _recording_speed(session)
    actions += draw_action_item(session, timeline_drag.fit_timeline)
    actions += draw_action_item(session, graph.toggle_graph)
    imgui.separator()
    return actions + draw_time_items(session, look, project)


def _fps(project: Project) -> list[Action]:
    fps = project.document.fps
    changed, wanted = imgui.drag_float("##fps", fps, 0.1, SLOWEST, FASTEST, "%.4g fps")
    draw_tooltip(_("Frames per second: drag, or click to type"))
    return [do(keys.set_fps, round(wanted, 3))] if changed else []


def _speed(project: Project) -> list[Action]:
    """Draw the menu of playback speeds. The animation itself does not change."""
    current = project.timeline.playhead.speed
    if not imgui.begin_menu(f"{_('Playback speed')}: {current:g}×###speed"):
        return []
    actions = [
        do(playback.set_playback_speed, speed)
        for speed in playback.SPEEDS
        if imgui.menu_item(f"{speed:g}×", "", speed == current)[0]
    ]
    imgui.end_menu()
    return actions


def _recording_speed(session: Session) -> list[Action]:
    """Draw the menu of the timeline's speeds while a drag is recorded."""
    current = session.tools.recording_speed
    if not imgui.begin_menu(f"{_('Recording speed')}: {current:.0%}###recording"):
        return []
    actions = [
        do(set_recording_speed, speed)
        for speed in RECORDING_SPEEDS
        if imgui.menu_item(f"{speed:.0%}", "", speed == current)[0]
    ]
    imgui.end_menu()
    return actions
