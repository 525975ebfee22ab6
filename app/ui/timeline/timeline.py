"""The timeline's panel: transport, ruler, and rows with keys and easing."""

from imgui_bundle import ImVec2, imgui

from app.document import display_frame
from app.editor import Action, KeyDrag, Project, ScrubDrag, Session, TimeDrag, TimeGesture, do
from app.editor.actions import editing, playback
from app.editor.actions.timing import timeline_drag
from app.editor.tools import tool_pointer
from app.texts import _, ngettext
from app.ui.shortcuts.keys import CTRL, format_modified
from app.ui.style.theme import Look
from app.ui.timeline.bar import draw_transport_bar
from app.ui.timeline.dropping import accept_dropped_pose
from app.ui.timeline.graph.graph import (
    click_in_graph,
    describe_graph_place,
    draw_graph_plane,
    draw_graph_points,
    follow_graph_drag,
    is_graph_gesture,
)
from app.ui.timeline.graph.plane import is_number_zoom
from app.ui.timeline.graph.view import GraphView
from app.ui.timeline.keys import draw_keys
from app.ui.timeline.layout import THIN, TimelineLayout, format_seconds, was_dragged
from app.ui.timeline.row import ChannelLane
from app.ui.timeline.rows.background import draw_key_box, draw_track_background
from app.ui.timeline.rows.cycles import draw_cycle_bars
from app.ui.timeline.rows.lanes import draw_lane_keys
from app.ui.timeline.rows.layers import draw_layer_rows
from app.ui.timeline.rows.segments import draw_pose_segments
from app.ui.timeline.rows.sounds import draw_sound_lanes
from app.ui.timeline.ruler.edges import draw_range_edges
from app.ui.timeline.ruler.markers import draw_markers
from app.ui.timeline.ruler.ruler import draw_overview, draw_playhead, draw_ruler

HINT_SOURCE = "timeline"
ZOOM_STEP = 1.2  # per notch of the wheel
SCROLL_STEP = 4.0  # em
# Share of the distance beyond the edge by which the view scrolls in each frame.
PULL = 0.12
FLAGS = imgui.WindowFlags_.no_scrollbar | imgui.WindowFlags_.no_scroll_with_mouse


def draw_timeline_panel(session: Session, look: Look, project: Project) -> list[Action]:
    actions = draw_transport_bar(session, look, project)
    imgui.begin_child("track", imgui.get_content_region_avail(), 0, FLAGS)
    bands = TimelineLayout(session, look, project)
    if bands.is_usable:
        actions += _draw_track(bands, playback.current_frame(session, project))
    imgui.end_child()
    return actions


def _draw_track(bands: TimelineLayout, frame: int) -> list[Action]:
    view = GraphView(bands) if bands.is_graph else None
    actions = draw_ruler(bands, frame)
    if view is None:
        actions += draw_track_background(bands)
        actions += draw_layer_rows(bands, frame)
        actions += draw_sound_lanes(bands)
    else:
        actions += draw_graph_plane(view, frame)
    actions += _navigate(bands, view)
    if view is None:
        actions += draw_pose_segments(bands)
        actions += draw_cycle_bars(bands)
    actions += draw_range_edges(bands)
    actions += draw_markers(bands)
    actions += draw_playhead(bands, frame)
    if view is None:
        actions += draw_keys(bands)
        actions += draw_lane_keys(bands)
        draw_key_box(bands)
        actions += accept_dropped_pose(bands)
        actions += _follow_active(bands)
    else:
        actions += draw_graph_points(view)
    actions += draw_overview(bands, frame)
    actions += _go_on(bands, view)
    actions += _follow(bands, frame)
    actions += _update_hint(bands, view)
    imgui.set_cursor_screen_pos(bands.corner)
    imgui.dummy(ImVec2(0, 0))
    return actions


def _update_hint(bands: TimelineLayout, view: GraphView | None) -> list[Action]:
    """Set the hint for the place under the pointer, and take it away when the pointer leaves."""
    is_over = imgui.is_window_hovered() or bands.project.timeline.gesture is not None
    tools, hint = bands.session.tools, _hint(bands, view) if is_over else ""
    if hint == tools.hint or not (is_over or tools.hint_source == HINT_SOURCE):
        return []
    return [do(tool_pointer.show_hint, hint, HINT_SOURCE)]


def _navigate(bands: TimelineLayout, view: GraphView | None) -> list[Action]:
    """Scroll with the wheel or the middle button. Zoom at the pointer with Ctrl and the wheel."""
    io = imgui.get_io()
    if view is not None and is_number_zoom(view) and not io.key_ctrl and not imgui.is_mouse_down(2):
        return []
    if not imgui.is_window_hovered(imgui.HoveredFlags_.allow_when_blocked_by_active_item):
        return []
    em, frames = bands.look.em, bands.project.document.frames
    strip = bands.time_view
    wheels_rows = imgui.get_mouse_pos().x < bands.left and not io.key_ctrl
    if wheels_rows and io.mouse_wheel:
        to = bands.project.timeline.scrolled - THIN * io.mouse_wheel
        return [do(timeline_drag.scroll_rows, min(max(to, 0.0), bands.overflow / em))]
    if io.key_ctrl and io.mouse_wheel:
        place = (imgui.get_mouse_pos().x - bands.left) / em
        strip = strip.zoomed(ZOOM_STEP**io.mouse_wheel, place)
    elif io.mouse_wheel or io.mouse_wheel_h:
        strip = strip.panned(-SCROLL_STEP * (io.mouse_wheel + io.mouse_wheel_h))
    if imgui.is_mouse_down(imgui.MouseButton_.middle) and io.mouse_delta.x:
        strip = strip.panned(-io.mouse_delta.x / em)
    if strip is bands.time_view:
        return []
    return [do(timeline_drag.set_time_range, strip.kept_near(frames, bands.width))]


def _go_on(bands: TimelineLayout, view: GraphView | None) -> list[Action]:
    """Continue the active gesture at the pointer. End it when the button is released."""
    timeline = bands.project.timeline
    gesture = timeline.gesture
    if gesture is None:
        return []
    if imgui.is_key_pressed(imgui.Key.escape):
        return [do(timeline_drag.cancel_timeline_drag)]
    # A press without a drag is a click. Only the playhead moves at once.
    goes_on = isinstance(gesture, ScrubDrag) or was_dragged()
    moves: list[Action] = []
    if goes_on and view is not None and is_graph_gesture(gesture):
        moves = follow_graph_drag(view)
    elif goes_on:
        moves = [do(timeline_drag.move_timeline_drag, bands.pointed, bands.pointed_channel)]
    if imgui.is_mouse_down(imgui.MouseButton_.left):
        return [*moves, *_scroll_beyond_edges(bands)] if goes_on else []
    if not was_dragged():
        is_own = view is not None and is_graph_gesture(gesture)
        moves += click_in_graph(view, gesture) if view and is_own else _click(bands, gesture)
    return [*moves, do(timeline_drag.end_timeline_drag)]


def _click(bands: TimelineLayout, gesture: TimeGesture) -> list[Action]:
    """Return the actions of a click, which is a press released without a drag."""
    match gesture:
        case ScrubDrag():
            return [do(editing.deselect_keys)]
        case KeyDrag(channel=channel, pressed=frame, mark=keys, copies=False):
            # Select only the keys of this mark, and show their frame.
            document = bands.project.document
            seen = document.frames.clamp(display_frame(document, channel, frame))
            return [do(editing.select_channel_keys, keys), do(playback.scrub, seen)]
        case _:
            return []


def _scroll_beyond_edges(bands: TimelineLayout) -> list[Action]:
    """Scroll while a drag goes beyond the edges."""
    x = imgui.get_mouse_pos().x
    beyond = min(x - bands.left, 0.0) + max(x - bands.right, 0.0)
    if not beyond:
        return []
    strip = bands.time_view.panned(PULL * beyond / bands.look.em)
    if isinstance(bands.project.timeline.gesture, TimeDrag):
        return [do(timeline_drag.set_time_range, strip)] if strip.frame(bands.width / 2) > 0 else []
    return [
        do(
            timeline_drag.set_time_range,
            strip.kept_near(bands.project.document.frames, bands.width),
        )
    ]


def _follow(bands: TimelineLayout, frame: int) -> list[Action]:
    """Keep the playhead visible when it moves without a drag."""
    timeline = bands.project.timeline
    if frame == timeline.last_shown_frame:
        return []
    strip = bands.time_view
    if timeline.gesture is None and timeline.time_range is not None:
        is_playing = bands.project.timeline.playhead.since is not None
        strip = strip.showing(frame, bands.width, turns=is_playing)
    return [
        do(
            timeline_drag.scroll_to_playhead,
            frame,
            strip if strip is not bands.time_view else None,
        )
    ]


def _follow_active(bands: TimelineLayout) -> list[Action]:
    """Scroll to a newly selected row, or to tracks that were added to it."""
    timing, row, em = bands.project.timeline, bands.row, bands.look.em
    if timing.last_shown_rows == (bands.project.channel, timing.expanded_layers):
        return []
    own = [lane for lane in bands.lanes if lane.layer is row.layer]
    chosen = next((lane for lane in own if lane.is_chosen), None)
    top = row.top if chosen is None else chosen.top
    bottom = max((lane.bottom for lane in own), default=row.bottom)
    bottom = bottom if chosen is None else chosen.bottom
    by = min(max(bottom - bands.track_bottom, 0.0), top - bands.track_top)
    scrolled = min(timing.scrolled, bands.overflow / em)
    return [do(timeline_drag.scroll_rows, scrolled + by / em)]


def _hint(bands: TimelineLayout, view: GraphView | None) -> str:
    gesture = bands.project.timeline.gesture
    if isinstance(gesture, KeyDrag):
        text = (
            ngettext(
                "Copied by {count:+d} frame, {time}. Esc cancels.",
                "Copied by {count:+d} frames, {time}. Esc cancels.",
                abs(gesture.by),
            )
            if gesture.copies
            else ngettext(
                "Moved by {count:+d} frame, {time}. Esc cancels.",
                "Moved by {count:+d} frames, {time}. Esc cancels.",
                abs(gesture.by),
            )
        )
        time = format_seconds(gesture.by, bands.project.document.fps)
        return text.format(count=gesture.by, time=time)
    if gesture is not None:
        return _("Esc cancels") if isinstance(gesture, TimeDrag) else ""
    if view is not None and (imgui.get_mouse_pos().y >= bands.track_top):
        return describe_graph_place(view)
    return _hint_of_place(bands)


def _hint_of_place(bands: TimelineLayout) -> str:
    x, y = imgui.get_mouse_pos()
    if x < bands.left:
        row = bands.pointed_row
        if isinstance(row, ChannelLane) and row.track is not None:
            return _(
                "Click a track to select it: then keys and drags of its handle go to the track"
            )
        return _(
            "Click a layer to see its handles and keys, wheel to see more layers, right-click for "
            "its menu"
        )
    if y < bands.ruler_top:
        return _("Drag the ends of the preview range, double-click to play all frames")
    if bands.sounds_top <= y < bands.track_top:
        text = _("Drag a sound to move it, drag its ends to cut it, right-click for more")
    elif bands.camera_top <= y < bands.sounds_top:
        text = _("Click a camera key to go there, drag to move it, right-click for more")
    elif bands.markers_top <= y < bands.camera_top:
        text = _("Click a marker to go there, drag it to move it, double-click to name it")
    elif y < bands.track_top:
        text = _("Drag to move the playhead, wheel to scroll, {gesture} to zoom").format(
            gesture=format_modified(CTRL, _("wheel"))
        )
    else:
        text = _("Drag keys to move them, {gesture} to copy, click between keys for easing").format(
            gesture=format_modified(CTRL, _("drag"))
        )
    return text
