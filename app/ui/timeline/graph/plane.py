"""The plane of the graph: its grid, its curves, and presses beside points."""

import numpy as np
from imgui_bundle import ImVec2, imgui

from app.document import ChannelCurve, keys_in
from app.editor import Action, CurvePoint, PointBox, do
from app.editor.actions.timing import graph, graph_drag, keys
from app.texts import _
from app.ui.style.theme import SMALL, colour_u32
from app.ui.style.widgets import begin_tooltip, is_pressed, push_text_size
from app.ui.timeline.graph.view import GraphView
from app.ui.timeline.keys import select_lane
from app.ui.timeline.layout import ROUNDING, was_dragged
from app.ui.timeline.menus import draw_track_menu

ZOOM_STEP = 1.2  # per notch of the wheel
NEAR = 0.6  # em: distance up to which the pointer is on a curve
AXIS = 3.2  # em: width of the labels, where the wheel zooms the numbers
WIDTH = 0.13  # em: of a curve


def draw_plane(view: GraphView) -> list[Action]:
    """Draw the frames and the grid, and handle the pointer beside points."""
    bands, palette = view.bands, view.bands.look.palette
    draw_list, em = imgui.get_window_draw_list(), bands.look.em
    low, high = ImVec2(bands.left, bands.track_top), ImVec2(bands.right, bands.track_bottom)
    draw_list.add_rect_filled(low, high, colour_u32(palette.desk), ROUNDING * em)
    draw_list.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    document = bands.project.document
    for frames, alpha in ((document.frames, 0.45), (document.played_frames, 1.0)):
        begin, end = bands.x(frames.first), bands.x(frames.last)
        draw_list.add_rect_filled(
            ImVec2(begin, low.y), ImVec2(end, high.y), colour_u32(palette.panel, alpha)
        )
    for index, unit in enumerate(view.ranges):
        if index < 2:
            _draw_axis(view, unit, at_right=bool(index))
    actions = _press_plane(view, low, high)
    _draw_curves(view)
    draw_list.pop_clip_rect()
    return actions


def _draw_axis(view: GraphView, unit: str, *, at_right: bool) -> None:
    """Draw round numbers at an edge; those at the left have lines."""
    bands, draw_list, em = view.bands, imgui.get_window_draw_list(), view.bands.look.em
    palette = bands.look.palette
    with push_text_size(SMALL):
        for number in view.ticks(unit):
            y = view.y(unit, number)
            if not at_right:
                strength = 1.0 if number == 0 else 0.45
                draw_list.add_line(
                    ImVec2(bands.left, y),
                    ImVec2(bands.right, y),
                    colour_u32(palette.line, strength),
                )
            text = view.label(unit, number)
            size = imgui.calc_text_size(text)
            x = bands.right - size.x - 0.4 * em if at_right else bands.left + 0.4 * em
            if bands.track_top < y - size.y:
                draw_list.add_text(
                    ImVec2(x, y - size.y), colour_u32(view.axis_colour(unit), 0.9), text
                )


def _draw_curves(view: GraphView) -> None:
    hovered = find_hovered_curve(view) if view.bands.project.timeline.gesture is None else None
    for curve in view.curves:
        colour, em = view.colours[curve], view.bands.look.em
        is_on = curve.channel == view.bands.project.channel or curve == hovered
        xs, ys = view.line(curve)
        ys = np.clip(ys, view.bands.track_top - 1e4, view.bands.track_bottom + 1e4)
        width = WIDTH * em * (1.5 if curve == hovered else 1.0)
        for run in np.split(np.arange(len(xs)), np.flatnonzero(np.isnan(ys))):
            places = [ImVec2(xs[i], ys[i]) for i in run.tolist() if not np.isnan(ys[i])]
            if len(places) > 1:
                imgui.get_window_draw_list().add_polyline(
                    list(places), colour_u32(colour, 1.0 if is_on else 0.75), width, 0
                )


def find_hovered_curve(view: GraphView) -> ChannelCurve | None:
    """Return the curve under the pointer, if the pointer is on the plane."""
    mouse, em = imgui.get_mouse_pos(), view.bands.look.em
    if not (view.bands.left <= mouse.x <= view.bands.right):
        return None
    if not (view.bands.track_top <= mouse.y <= view.bands.track_bottom):
        return None
    found, least = None, NEAR * em
    for curve in view.curves:
        xs, ys = view.line(curve)
        away = np.hypot(xs - mouse.x, ys - mouse.y)
        if np.all(np.isnan(away)):
            continue
        # Also between two samples, where the curve is nearly level.
        level = abs(float(np.interp(mouse.x, xs, ys)) - mouse.y)
        distance = min(float(np.nanmin(away)), level)
        if distance < least:
            found, least = curve, distance
    return found


def _press_plane(view: GraphView, low: ImVec2, high: ImVec2) -> list[Action]:
    bands, io, mouse = view.bands, imgui.get_io(), imgui.get_mouse_pos()
    actions: list[Action] = []
    clicked = bands.button("plane", low, high, right=True)
    is_hovered = imgui.is_item_hovered()
    curve = find_hovered_curve(view) if is_hovered else None
    twice = is_hovered and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
    if curve is not None and (twice or (is_pressed() and io.key_ctrl)):
        return _insert_key(view, curve)
    if is_pressed():
        actions += _begin_box(view, mouse)
    if clicked and imgui.is_mouse_released(imgui.MouseButton_.left) and not was_dragged():
        actions += _click_curve(view, curve)
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        if curve is not None and curve.channel != bands.project.channel:
            actions += select_lane(curve.channel, {})
        imgui.open_popup("menu of track")
    if is_hovered and curve is not None and bands.project.timeline.gesture is None:
        _draw_reading(view, curve, mouse)
    if imgui.is_window_hovered() and low.y <= mouse.y <= high.y and mouse.x >= low.x:
        # Also on points.
        actions += _navigate_numbers(view, mouse)
    return actions + draw_track_menu(bands)


def _insert_key(view: GraphView, curve: ChannelCurve) -> list[Action]:
    frame = round(view.bands.pointed)
    if frame not in view.document.frames:
        return []
    return [*select_lane(curve.channel, {}), do(keys.insert_key_in_row_at, frame)]


def _begin_box(view: GraphView, mouse: ImVec2) -> list[Action]:
    """Begin a box selection of points. With Shift, it adds to the selected points."""
    project, adds = view.bands.project, imgui.get_io().key_shift
    box = PointBox(
        start=view.bands.pointed,
        channel=project.channel,
        keeps=project.selection.keys if adds else {},
        numbers=view.place(mouse).numbers,
        points=view.chosen if adds else frozenset(),
    )
    return [do(graph_drag.begin_graph_drag, box, view.bands.time_view, view.ranges)]


def _click_curve(view: GraphView, curve: ChannelCurve | None) -> list[Action]:
    """Select all points of a curve; beside the curves, no point."""
    adds = imgui.get_io().key_shift
    if curve is None:
        return [] if adds else [do(graph.select_points, frozenset())]
    own = {CurvePoint(curve, key.frame) for key in keys_in(view.document, curve.channel)}
    points = view.chosen | own if adds else frozenset(own)
    return [*select_lane(curve.channel, {}), do(graph.select_points, points)]


def _navigate_numbers(view: GraphView, mouse: ImVec2) -> list[Action]:
    """Zoom the numbers with Shift and the wheel, or with the wheel on the axis; pan them."""
    io = imgui.get_io()
    wheel = io.mouse_wheel or io.mouse_wheel_h
    if wheel and is_number_zoom(view):
        return [do(graph.show_ranges, view.zoomed(ZOOM_STEP**-wheel, mouse.y))]
    if imgui.is_mouse_down(imgui.MouseButton_.middle) and io.mouse_delta.y:
        return [do(graph.show_ranges, view.panned(io.mouse_delta.y))]
    return []


def is_number_zoom(view: GraphView) -> bool:
    """Return whether the wheel zooms the numbers at the pointer."""
    beside = imgui.get_mouse_pos().x - view.bands.left
    return imgui.get_io().key_shift or 0 <= beside < AXIS * view.bands.look.em


def _draw_reading(view: GraphView, curve: ChannelCurve, mouse: ImVec2) -> None:
    """Mark the curve at the pointer, and tell its number and frame."""
    bands, em = view.bands, view.bands.look.em
    xs, ys = view.line(curve)
    y = float(np.interp(mouse.x, xs, ys))
    if np.isnan(y):
        return
    draw_list, palette = imgui.get_window_draw_list(), bands.look.palette
    draw_list.add_circle_filled(ImVec2(mouse.x, y), 0.3 * em, colour_u32(palette.desk))
    draw_list.add_circle_filled(ImVec2(mouse.x, y), 0.22 * em, colour_u32(view.colours[curve]))
    if begin_tooltip():
        frame = _("frame {frame}").format(frame=f"{bands.pointed:.1f}")
        imgui.text_colored(view.colours[curve], curve.label)
        imgui.same_line()
        imgui.text_unformatted(view.label(curve, view.number(curve.unit, y)))
        imgui.text_disabled(frame)
        imgui.end_tooltip()


def draw_point_box(view: GraphView) -> None:
    """Draw the box that selects points."""
    gesture, mouse = view.bands.project.timeline.gesture, imgui.get_mouse_pos()
    if not isinstance(gesture, PointBox) or not was_dragged() or not gesture.numbers:
        return
    draw_list, accent = imgui.get_window_draw_list(), view.bands.look.palette.accent
    unit, number = next(iter(gesture.numbers.items()))
    left, right = sorted((view.bands.x(gesture.start), mouse.x))
    top, bottom = sorted((view.y(unit, number), mouse.y))
    low = ImVec2(max(left, view.bands.left), max(top, view.bands.track_top))
    high = ImVec2(right, min(bottom, view.bands.track_bottom))
    draw_list.add_rect_filled(low, high, colour_u32(accent, 0.14), 2.0)
    draw_list.add_rect(low, high, colour_u32(accent, 0.8), 2.0)
