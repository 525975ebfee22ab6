"""Points of curves, which are keys, and the handles of their tangents."""

from imgui_bundle import ImVec2, imgui

from app.document import (
    BaseKey,
    ChannelCurve,
    Side,
    TangentMode,
    describe_channel,
    find_tangent_handle,
    keys_in,
)
from app.editor import Action, CurvePoint, KeyDrag, PointDrag, TangentDrag, do
from app.editor.actions import playback
from app.editor.actions.timing import graph, graph_drag
from app.editor.actions.timing.graph import group_by_channel
from app.texts import _
from app.ui.shortcuts.keys import CTRL, SHIFT, format_modified
from app.ui.style.theme import colour_u32
from app.ui.style.widgets import begin_tooltip, is_hovered_or_held, is_pressed
from app.ui.timeline.graph.view import GraphView
from app.ui.timeline.keys import draw_key_mark, find_drag_origin, label_dragged_key, select_lane
from app.ui.timeline.layout import format_seconds
from app.ui.timeline.menus import TANGENT_MODES, draw_key_menu

RADIUS, GRIP = 0.36, 0.5  # em: half a point's diagonal, and half its hit box
HANDLE, HANDLE_GRIP = 0.22, 0.42  # em: radius of a tangent's handle, and half its hit box
MOST_TANGENTS = 40  # selected points up to which tangents are shown


def draw_points(view: GraphView) -> list[Action]:
    """Draw the points of all curves, with the tangents of the selected ones."""
    actions: list[Action] = []
    bands, points = view.bands, view.points()
    low, high = ImVec2(bands.left, bands.track_top), ImVec2(bands.right, bands.track_bottom)
    imgui.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    if len(view.chosen) <= MOST_TANGENTS and not view.is_speed:
        for point, index in points:
            if point in view.chosen:
                actions += _draw_tangents(view, point, index)
    # The selected points come last: of points at one place they take the press.
    for point, index in sorted(points, key=lambda each: each[0] in view.chosen):
        actions += _draw_point(view, point, index)
    imgui.pop_clip_rect()
    return actions


def _name(curve: ChannelCurve) -> str:
    channel = curve.channel
    return f"{channel.kind.name} {channel.layer} {channel.part} {curve.field.name} {curve.part}"


def _draw_point(view: GraphView, point: CurvePoint, index: int) -> list[Action]:
    bands, em, curve = view.bands, view.bands.look.em, point.curve
    gesture, centre = bands.project.timeline.gesture, view.point_place(point, index)
    key = keys_in(view.document, curve.channel)[index]
    origin = find_drag_origin(gesture, curve.channel, point.frame)
    grip = ImVec2(GRIP * em, GRIP * em)
    imgui.push_id(_name(curve))
    bands.button(f"point {origin}", centre - grip, centre + grip, right=True)
    actions: list[Action] = []
    if is_pressed():
        actions += _press_point(view, point)
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        points = view.chosen if point in view.chosen else frozenset({point})
        actions += [*select_lane(curve.channel, {}), do(graph.select_points, points)]
        imgui.open_popup(f"menu of key {point.frame}")
    _draw_mark(view, point, key, centre, is_large=is_hovered_or_held())
    label_dragged_key(bands, curve.channel, point.frame, centre.x)
    if not isinstance(gesture, KeyDrag):
        _draw_point_tooltip(view, point, key, index)
    actions += draw_key_menu(bands, curve.channel, key)
    imgui.pop_id()
    return actions


def _press_point(view: GraphView, point: CurvePoint) -> list[Action]:
    """Begin a drag of the selected points. With Shift, the point is added to them."""
    bands, io = view.bands, imgui.get_io()
    points = view.chosen
    if point not in points:
        points = points | {point} if io.key_shift else frozenset({point})
    channel = point.curve.channel
    drag = PointDrag(
        keys=group_by_channel(points),
        channel=channel,
        pressed=point.frame,
        mark={channel: frozenset({point.frame})},
        start=bands.pointed,
        copies=io.key_ctrl,
        points=points,
        numbers=view.place(imgui.get_mouse_pos()).numbers,
        is_speed=view.is_speed,
        was_chosen=point in view.chosen,
        point=point,
    )
    return [
        *select_lane(channel, drag.keys),
        do(graph.select_points, points),
        do(graph_drag.begin_graph_drag, drag, bands.time_view, view.ranges),
    ]


def click_point(view: GraphView, drag: PointDrag) -> list[Action]:
    """Return the actions of a press that was released without a drag.

    The point is selected alone, and its frame is shown. With Shift, a selected one is deselected.
    """
    if imgui.get_io().key_shift:
        left = drag.points - {drag.point} if drag.was_chosen else drag.points
        return [do(graph.select_points, left)]
    frame = round(view.bands.frame(view.bands.x_of(drag.channel, drag.point.frame)))
    return [
        do(graph.select_points, frozenset({drag.point})),
        do(playback.scrub, view.document.frames.clamp(frame)),
    ]


def _draw_mark(
    view: GraphView, point: CurvePoint, key: BaseKey, centre: ImVec2, *, is_large: bool
) -> None:
    palette, em = view.bands.look.palette, view.bands.look.em
    is_held = point.curve.channel.kind.is_held
    tangent = TangentMode.HOLD if is_held else key.shown_tangent_mode
    radius = (1.2 if is_large else 1.0) * RADIUS * em
    is_chosen = point in view.chosen
    if is_chosen:
        draw_key_mark(tangent, centre, radius + 0.22 * em, colour_u32(palette.accent, 0.5))
    draw_key_mark(tangent, centre, radius + 0.1 * em, colour_u32(palette.desk))
    colour = palette.text if is_chosen else view.colours[point.curve]
    draw_key_mark(tangent, centre, radius, colour_u32(colour))


def _draw_tangents(view: GraphView, point: CurvePoint, index: int) -> list[Action]:
    """Draw the handles of a point's tangents. They can be dragged."""
    bands, em, curve = view.bands, view.bands.look.em, point.curve
    draw_list, palette = imgui.get_window_draw_list(), bands.look.palette
    key = keys_in(view.document, curve.channel)[index]
    number = curve.number_at_key(view.document, key)
    centre, actions = view.point_place(point, index), list[Action]()
    sides: tuple[Side, Side] = (0, 1)
    for side in sides:
        handle = find_tangent_handle(view.document, curve, index, side)
        if handle is None:
            continue
        frames = handle.frames if side else -handle.frames
        x = centre.x + frames * bands.time_view.scale * em
        end = ImVec2(x, view.y(curve.unit, number + handle.change))
        grip = ImVec2(HANDLE_GRIP * em, HANDLE_GRIP * em)
        imgui.push_id(_name(curve))
        bands.button(f"tangent {point.frame} {side}", end - grip, end + grip)
        imgui.pop_id()
        if is_pressed():
            drag = TangentDrag(start=bands.pointed, point=point, side=side)
            actions.append(do(graph_drag.begin_graph_drag, drag, bands.time_view, view.ranges))
        is_hot = is_hovered_or_held()
        colour = colour_u32(palette.accent if is_hot else view.colours[curve])
        draw_list.add_line(centre, end, colour_u32(view.colours[curve], 0.8), 1.5)
        draw_list.add_circle_filled(end, (HANDLE + 0.1) * em, colour_u32(palette.desk))
        draw_list.add_circle_filled(end, (1.2 if is_hot else 1.0) * HANDLE * em, colour)
        if bands.project.timeline.gesture is None and begin_tooltip():
            text = _("Drag the tangent, {gesture} for a level one")
            imgui.text_unformatted(text.format(gesture=format_modified(SHIFT, _("drag"))))
            imgui.end_tooltip()
    return actions


def _draw_point_tooltip(view: GraphView, point: CurvePoint, key: BaseKey, index: int) -> None:
    if not begin_tooltip():
        return
    document, curve = view.document, point.curve
    imgui.text_colored(view.colours[curve], curve.label)
    imgui.same_line()
    number = graph.height_of(view.bands.project, curve, index)
    imgui.text_unformatted(view.label(curve, number))
    text = _("{channel}, frame {frame}")
    name = describe_channel(document, curve.channel)
    imgui.text_unformatted(text.format(channel=name, frame=key.frame))
    imgui.same_line()
    imgui.text_disabled(format_seconds(key.frame, document.fps))
    if not curve.channel.kind.is_held:
        mode, hint = TANGENT_MODES[key.shown_tangent_mode]
        imgui.text_unformatted(mode)
        imgui.text_disabled(hint)
    text = _("Drag to move, {shift} along one axis, {ctrl} to copy")
    imgui.text_disabled(
        text.format(shift=format_modified(SHIFT, _("drag")), ctrl=format_modified(CTRL, _("drag")))
    )
    imgui.end_tooltip()
