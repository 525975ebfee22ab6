"""Drags of points and tangents in the graph."""

from dataclasses import replace

from app.document import (
    Command,
    Document,
    TangentHandle,
    TimeScale,
    curve_commands,
    display_frame,
    keys_in,
)
from app.editor.actions.timing import graph
from app.editor.actions.timing.keys import edit_timing
from app.editor.actions.timing.timeline_drag import (
    begin_timeline_drag,
    drag_offset,
    end_timeline_drag,
)
from app.editor.parts.timeline.gestures import (
    CurvePoint,
    GraphGesture,
    GraphPlace,
    PointBox,
    PointDrag,
    PointScale,
    TangentDrag,
    TimeDrag,
)
from app.editor.parts.timeline.graph import NumberRanges
from app.editor.parts.timeline.time_range import TimeRangeView
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.errors import LissomError

LEAST_TIME_FACTOR = 0.01


@with_project
def begin_graph_drag(
    session: Session,
    project: Project,
    gesture: GraphGesture,
    time_range: TimeRangeView,
    ranges: NumberRanges,
) -> None:
    """Begin a gesture in the graph; the shown ranges of time and numbers are fixed."""
    project.graph.fix_ranges(ranges)
    begin_timeline_drag(session, gesture, time_range)


@with_project
def move_graph_drag(session: Session, project: Project, place: GraphPlace) -> None:
    """Follow the pointer to a place in the graph."""
    gesture, before = project.timeline.gesture, project.history.committed
    if isinstance(gesture, PointBox):
        graph.select_points(session, _inside(project, gesture, place))
        return
    if not isinstance(gesture, TimeDrag):
        return
    if project.history.has_ended(gesture.gesture):
        end_timeline_drag(session)
        return
    try:
        match gesture:
            case PointDrag():
                _move_points(session, before, gesture, place)
            case PointScale():
                _scale_points(session, before, gesture, place)
            case TangentDrag():
                _turn_tangent(session, before, gesture, place)
    except LissomError:
        # Keys stop before others in their way, and before a cycle.
        return


@with_project
def _move_points(
    session: Session, project: Project, before: Document, drag: PointDrag, place: GraphPlace
) -> None:
    by = 0
    if place.axis != "value" and not drag.is_speed:
        by = drag_offset(before, drag.keys, round(place.frame - drag.start), copies=drag.copies)
    units = drag.numbers.keys() & place.numbers.keys()
    changes = {unit: place.numbers[unit] - drag.numbers[unit] for unit in units}
    if place.axis == "time" or (drag.copies and not by):
        changes = {}
    points = [(each.curve, each.frame) for each in drag.points]
    if drag.is_speed:
        command = curve_commands.change_velocities(points, changes)
    else:
        command = curve_commands.move_points(drag.keys, points, by, changes, copies=drag.copies)
    _edit(session, before, drag, command)
    graph.select_points(
        session, frozenset(CurvePoint(each.curve, each.frame + by) for each in drag.points)
    )
    project.timeline.move_gesture(replace(drag, by=by))


def _scale_points(session: Session, before: Document, drag: PointScale, place: GraphPlace) -> None:
    scale, factor = None, 1.0
    if drag.fixed_frame is not None:
        longer = 1.0 + (place.frame - drag.start) / drag.length
        scale = TimeScale(drag.fixed_frame, max(longer, LEAST_TIME_FACTOR))
    for unit in drag.fixed_numbers.keys() & place.numbers.keys():
        # The same for all units, since all of them scale with the window.
        factor = 1.0 + (place.numbers[unit] - drag.numbers[unit]) / drag.heights[unit]
    points = [(each.curve, each.frame) for each in drag.points]
    _edit(
        session,
        before,
        drag,
        curve_commands.scale_points(drag.keys, points, scale, drag.fixed_numbers, factor),
    )
    placed = (
        CurvePoint(each.curve, each.frame if scale is None else scale(each.frame))
        for each in drag.points
    )
    graph.select_points(session, frozenset(placed))


def _turn_tangent(session: Session, before: Document, drag: TangentDrag, place: GraphPlace) -> None:
    curve, frame = drag.point.curve, drag.point.frame
    key = next(each for each in keys_in(before, curve.channel) if each.frame == frame)
    frames = place.frame - display_frame(before, curve.channel, frame)
    number = curve.number_at_key(before, key)
    # A curve that was hidden meanwhile keeps its tangent level.
    change = place.numbers.get(curve.unit, number) - number
    # Constrained, the tangent is level.
    handle = TangentHandle(
        max(frames if drag.side else -frames, 0.0), change if place.axis is None else 0.0
    )
    _edit(session, before, drag, curve_commands.move_tangent(curve, frame, drag.side, handle))


def _edit(session: Session, before: Document, drag: TimeDrag, command: Command) -> None:
    """Change the document before the drag by a command."""
    document = command(before)
    edit_timing(session, Command(command.label, lambda _: document), gesture=drag.gesture)


def _inside(project: Project, box: PointBox, place: GraphPlace) -> frozenset[CurvePoint]:
    """Return the points in a box that ends at a place, and those that the box keeps."""
    document = project.document
    first, last = sorted((box.start, place.frame))
    found = set(box.points)
    for curve in graph.shown_curves(project):
        if curve.unit not in box.numbers.keys() & place.numbers.keys():
            continue
        low, high = sorted((box.numbers[curve.unit], place.numbers[curve.unit]))
        for index, key in enumerate(keys_in(document, curve.channel)):
            at = display_frame(document, curve.channel, key.frame)
            if first <= at <= last and low <= graph.height_of(project, curve, index) <= high:
                found.add(CurvePoint(curve, key.frame))
    return frozenset(found)
