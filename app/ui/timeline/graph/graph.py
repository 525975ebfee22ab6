"""The graph in place of the lanes."""

from imgui_bundle import ImVec2, imgui

from app.document import FrameRange, display_frame
from app.editor import (
    Action,
    PointBox,
    PointDrag,
    PointScale,
    TangentDrag,
    TimeGesture,
    TimeRangeView,
    do,
)
from app.editor.actions.timing import graph, graph_drag, timeline_drag
from app.texts import _
from app.ui.shortcuts.keys import SHIFT, format_modified
from app.ui.style.drawing import draw_centred_text
from app.ui.style.theme import colour_u32
from app.ui.timeline.graph.legend import draw_legend
from app.ui.timeline.graph.plane import draw_plane, draw_point_box
from app.ui.timeline.graph.points import click_point, draw_points
from app.ui.timeline.graph.scaling import draw_scale_box
from app.ui.timeline.graph.view import GraphView

NO_CURVES = _("This channel has no numbers. Choose another one at the left.")


def draw_graph_plane(view: GraphView, frame: int) -> list[Action]:
    """Draw what lies below the playhead: the names, the grid and the curves."""
    actions = draw_legend(view, frame) + draw_plane(view)
    bands = view.bands
    if not graph.graphed_channels(bands.project):
        low, high = ImVec2(bands.left, bands.track_top), ImVec2(bands.right, bands.track_bottom)
        draw_centred_text(low, high, NO_CURVES, colour_u32(bands.look.palette.dim))
    return actions


def draw_graph_points(view: GraphView) -> list[Action]:
    """Draw what lies above the playhead: the points, with the box around selected ones."""
    actions = draw_scale_box(view) + draw_points(view)
    draw_point_box(view)
    return actions + _fit(view)


def follow_graph_drag(view: GraphView) -> list[Action]:
    """Move the gesture to the pointer. With Shift, a drag changes only the larger direction."""
    place, gesture = view.place(imgui.get_mouse_pos()), view.bands.project.timeline.gesture
    if imgui.get_io().key_shift and isinstance(gesture, (PointDrag, TangentDrag)):
        away = imgui.get_mouse_drag_delta(imgui.MouseButton_.left, 0.0)
        place = place._replace(axis="time" if abs(away.x) >= abs(away.y) else "value")
    return [do(graph_drag.move_graph_drag, place)]


def click_in_graph(view: GraphView, gesture: TimeGesture) -> list[Action]:
    """Return the actions of a gesture that was released without a drag."""
    return click_point(view, gesture) if isinstance(gesture, PointDrag) else []


def is_graph_gesture(gesture: TimeGesture | None) -> bool:
    return isinstance(gesture, (PointBox, PointDrag, PointScale, TangentDrag))


def describe_graph_place(view: GraphView) -> str:
    """Return the hint for the pointer's place in the graph."""
    mouse = imgui.get_mouse_pos()
    if mouse.x < view.bands.left:
        return _("Click a channel to see its curves, click a curve to show or hide it")
    text = _(
        "Drag points and tangents, double-click a curve for a key, {gesture} to zoom the values"
    )
    return text.format(gesture=format_modified(SHIFT, _("wheel")))


def _fit(view: GraphView) -> list[Action]:
    """Show the selected points if that was asked for, or everything if none is selected."""
    if not view.state.is_fitting:
        return []
    if not view.chosen:
        return [do(timeline_drag.fit_timeline)]
    frames = [display_frame(view.document, each.curve.channel, each.frame) for each in view.chosen]
    first, last = min(frames), max(frames)
    room = max(1, (last - first) // 8)
    around = FrameRange(max(first - room, 0), last + room)
    strip = TimeRangeView.fitting(around, view.bands.width)
    return [
        do(timeline_drag.set_time_range, strip),
        do(graph.show_ranges, view.fitted_to_points()),
    ]
