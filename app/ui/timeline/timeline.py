"""Keys in time: the transport above, the ruler, and the track with keys and easing."""

from imgui_bundle import ImVec2, imgui

from app.editor import (
    Action,
    EdgeDrag,
    KeyDrag,
    MarkerDrag,
    Project,
    Scrub,
    Session,
    SwitchDrag,
    TimeGesture,
    do,
    layering,
)
from app.editor.actions import editing, playback, timeline_pointing
from app.editor.tools import pointing
from app.ui.shortcuts import CTRL, with_key
from app.ui.style import Look
from app.ui.timeline.bar import draw_bar
from app.ui.timeline.dropping import draw_dropped
from app.ui.timeline.edges import draw_edges
from app.ui.timeline.intervals import draw_intervals
from app.ui.timeline.keys import draw_box, draw_ground, draw_keys
from app.ui.timeline.markers import draw_markers
from app.ui.timeline.rows import draw_rows
from app.ui.timeline.ruler import draw_overview, draw_playhead, draw_ruler
from app.ui.timeline.track import THIN, Track, in_seconds, was_dragged

ZOOM_STEP = 1.2  # a notch of the wheel
SCROLL_STEP = 4.0  # em
# Parts of the way beyond the edge by which the view follows the pointer in each frame.
PULL = 0.12
FLAGS = imgui.WindowFlags_.no_scrollbar | imgui.WindowFlags_.no_scroll_with_mouse


def draw(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the timeline of the open project."""
    actions = draw_bar(session, look, project)
    imgui.begin_child("track", imgui.get_content_region_avail(), 0, FLAGS)
    track = Track(session, look, project)
    if track.is_usable:
        actions += _draw_track(track, playback.current_frame(session, project))
    imgui.end_child()
    return actions


def _draw_track(track: Track, frame: int) -> list[Action]:
    actions = draw_ruler(track, frame)
    actions += draw_ground(track)
    actions += draw_rows(track, frame)
    actions += _navigate(track)
    actions += draw_intervals(track)
    actions += draw_edges(track)
    actions += draw_markers(track)
    actions += draw_playhead(track, frame)
    actions += draw_keys(track)
    draw_box(track)
    actions += draw_overview(track, frame)
    actions += _go_on(track)
    actions += draw_dropped(track)
    actions += _follow(track, frame) + _follow_active(track)
    if imgui.is_window_hovered() or track.project.timing.gesture is not None:
        actions.append(do(pointing.explain, _hint(track)))
    imgui.set_cursor_screen_pos(track.corner)
    imgui.dummy(ImVec2(0, 0))
    return actions


def _navigate(track: Track) -> list[Action]:
    """Scroll by the wheel or the middle button; zoom at the pointer with Ctrl."""
    io = imgui.get_io()
    if not imgui.is_window_hovered(imgui.HoveredFlags_.allow_when_blocked_by_active_item):
        return []
    em, frames = track.look.em, track.project.document.frames
    strip = track.strip
    wheels_rows = imgui.get_mouse_pos().x < track.left and not io.key_ctrl
    if wheels_rows and io.mouse_wheel:
        to = track.project.timing.scrolled - THIN * io.mouse_wheel
        return [do(timeline_pointing.scroll_rows, min(max(to, 0.0), track.overflow / em))]
    if io.key_ctrl and io.mouse_wheel:
        place = (imgui.get_mouse_pos().x - track.left) / em
        strip = strip.zoomed(ZOOM_STEP**io.mouse_wheel, place)
    elif io.mouse_wheel or io.mouse_wheel_h:
        strip = strip.panned(-SCROLL_STEP * (io.mouse_wheel + io.mouse_wheel_h))
    if imgui.is_mouse_down(imgui.MouseButton_.middle) and io.mouse_delta.x:
        strip = strip.panned(-io.mouse_delta.x / em)
    if strip is track.strip:
        return []
    return [do(timeline_pointing.look_at, strip.kept_near(frames, track.width))]


def _go_on(track: Track) -> list[Action]:
    """Follow the pointer in what it began; end it where the button is let go."""
    timeline = track.project.timing
    gesture = timeline.gesture
    if gesture is None:
        return []
    if imgui.is_key_pressed(imgui.Key.escape):
        return [do(timeline_pointing.cancel)]
    # A press that does not go on is a click; only the playhead is there at once.
    goes_on = isinstance(gesture, Scrub) or was_dragged()
    row = track.pointed_row.figure.id
    moves = [do(timeline_pointing.move, track.pointed, row)] if goes_on else []
    if imgui.is_mouse_down(imgui.MouseButton_.left):
        return [*moves, *_pull(track)] if goes_on else []
    if not was_dragged():
        moves += _click(gesture)
    return [*moves, do(timeline_pointing.end)]


def _click(gesture: TimeGesture) -> list[Action]:
    """Return what a press on something does that is let go where it was."""
    match gesture:
        case Scrub():
            return [do(editing.deselect_keys)]
        case KeyDrag(pressed=frame, copies=False):
            # The key alone, and its pose.
            return [do(editing.choose_keys, frozenset({frame})), do(playback.scrub, frame)]
        case MarkerDrag(marker=frame):
            return [do(playback.scrub, frame)]
        case SwitchDrag(figure=figure, switch=frame):
            return [do(layering.choose, figure), do(playback.scrub, frame)]
        case _:
            return []


def _pull(track: Track) -> list[Action]:
    """Scroll where the pointer goes beyond the edges."""
    x = imgui.get_mouse_pos().x
    beyond = min(x - track.left, 0.0) + max(x - track.right, 0.0)
    if not beyond:
        return []
    strip = track.strip.panned(PULL * beyond / track.look.em)
    if isinstance(track.project.timing.gesture, KeyDrag | EdgeDrag | MarkerDrag | SwitchDrag):
        return [do(timeline_pointing.look_at, strip)] if strip.frame(track.width / 2) > 0 else []
    return [
        do(timeline_pointing.look_at, strip.kept_near(track.project.document.frames, track.width))
    ]


def _follow(track: Track, frame: int) -> list[Action]:
    """Keep the playhead on the screen where it moves by itself."""
    timeline = track.project.timing
    if frame == timeline.seen:
        return []
    strip = track.strip
    if timeline.gesture is None and timeline.strip is not None:
        is_playing = track.project.playhead.since is not None
        strip = strip.showing(frame, track.width, turns=is_playing)
    return [do(timeline_pointing.follow, frame, strip if strip is not track.strip else None)]


def _follow_active(track: Track) -> list[Action]:
    """Scroll the rows to that of a figure that has become the active one."""
    timing, row, em = track.project.timing, track.row, track.look.em
    if timing.seen_row == row.figure.id:
        return []
    above, below = track.track_top - row.top, row.bottom - track.track_bottom
    scrolled = min(timing.scrolled, track.overflow / em)
    return [do(timeline_pointing.scroll_rows, scrolled + (max(below, 0.0) - max(above, 0.0)) / em)]


def _hint(track: Track) -> str:
    gesture = track.project.timing.gesture
    if isinstance(gesture, KeyDrag):
        what = "Copied" if gesture.copies else "Moved"
        seconds = in_seconds(gesture.by, track.project.document.fps)
        return f"{what} by {gesture.by:+d} frames, {seconds}: Esc takes it back"
    if gesture is not None:
        return (
            "Esc takes it back" if isinstance(gesture, EdgeDrag | MarkerDrag | SwitchDrag) else ""
        )
    return _hint_of_place(track)


def _hint_of_place(track: Track) -> str:
    x, y = imgui.get_mouse_pos()
    if x < track.left:
        return "Click a layer to see its handles and keys, wheel to see more layers"
    if y < track.ruler_top:
        return "Drag the ends of the preview range, double-click to play all frames"
    if track.marks_top <= y < track.track_top:
        return "Click a marker to go there, drag it to move it, double-click to name it"
    if y < track.track_top:
        return f"Drag to move the playhead, wheel to scroll, {with_key(CTRL, 'wheel')} to zoom"
    return (
        f"Drag keys to move them, {with_key(CTRL, 'drag')} to copy, click between keys for easing"
    )
