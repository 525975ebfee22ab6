"""The box around selected points, whose grips scale their time and values."""

from collections.abc import Iterator

from imgui_bundle import ImVec2, imgui

from app.editor import Action, PointScale, do
from app.editor.actions.timing import graph_drag
from app.editor.actions.timing.graph import group_by_channel
from app.ui.style.theme import colour_u32
from app.ui.style.widgets import is_hovered_or_held, is_pressed
from app.ui.timeline.graph.view import GraphView

PADDING, GRIP, SQUARE = 0.75, 0.45, 0.22  # em: around the points; halves of hit box and mark
LEAST = 0.5  # em: extent of the points below which they cannot be scaled


def draw_scale_box(view: GraphView) -> list[Action]:
    """Draw a box around two or more selected points, with grips."""
    places = [view.point_place(*each) for each in view.points() if each[0] in view.chosen]
    if len(places) < 2:
        return []
    em, palette = view.bands.look.em, view.bands.look.palette
    low = ImVec2(min(each.x for each in places), min(each.y for each in places))
    high = ImVec2(max(each.x for each in places), max(each.y for each in places))
    room, draw_list = ImVec2(PADDING * em, PADDING * em), imgui.get_window_draw_list()
    # Within the plane, as long as the points are.
    least, most = view.bands.track_top + SQUARE * em, view.bands.track_bottom - SQUARE * em
    top = ImVec2(low.x - room.x, max(low.y - room.y, min(low.y, least)))
    bottom = ImVec2(high.x + room.x, min(high.y + room.y, max(high.y, most)))
    draw_list.add_rect(top, bottom, colour_u32(palette.accent, 0.55), 0.2 * em)
    actions: list[Action] = []
    for right, down, place in _grips(top, bottom):
        # Each direction only if the points differ in it.
        across = right if high.x - low.x > LEAST * em else 0
        along = 0 if view.is_speed or high.y - low.y <= LEAST * em else down
        if (across, along) == (right, down):
            actions += _draw_grip(view, (across, along), place, (low, high))
    return actions


def _grips(low: ImVec2, high: ImVec2) -> Iterator[tuple[int, int, ImVec2]]:
    """Yield the grips of a box: their sides, −1 to 1 to the right and down, and their places."""
    middle = (low + high) / 2
    for right, x in ((-1, low.x), (0, middle.x), (1, high.x)):
        for down, y in ((-1, low.y), (0, middle.y), (1, high.y)):
            if right or down:
                yield right, down, ImVec2(x, y)


def _draw_grip(
    view: GraphView, side: tuple[int, int], place: ImVec2, box: tuple[ImVec2, ImVec2]
) -> list[Action]:
    bands, em, palette = view.bands, view.bands.look.em, view.bands.look.palette
    right, down = side
    grip = ImVec2(GRIP * em, GRIP * em)
    bands.button(f"scale {right} {down}", place - grip, place + grip)
    actions: list[Action] = []
    if is_pressed():
        low, high = box
        opposite = ImVec2(high.x if right < 0 else low.x, high.y if down < 0 else low.y)
        own = ImVec2(low.x if right < 0 else high.x, low.y if down < 0 else high.y)
        fixed, held = view.place(opposite), view.place(own)
        drag = PointScale(
            start=bands.pointed,
            keys=group_by_channel(view.chosen),
            points=view.chosen,
            numbers=view.place(imgui.get_mouse_pos()).numbers,
            fixed_frame=round(fixed.frame) if right else None,
            fixed_numbers=fixed.numbers if down else {},
            length=held.frame - fixed.frame,
            heights={unit: held.numbers[unit] - fixed.numbers[unit] for unit in held.numbers},
        )
        actions.append(do(graph_drag.begin_graph_drag, drag, bands.time_view, view.ranges))
    is_hot = is_hovered_or_held()
    if is_hot:
        imgui.set_mouse_cursor(_cursor(right, down))
    half = (1.25 if is_hot else 1.0) * SQUARE * em
    square = ImVec2(half, half)
    draw_list = imgui.get_window_draw_list()
    edge = ImVec2(half + 0.08 * em, half + 0.08 * em)
    draw_list.add_rect_filled(place - edge, place + edge, colour_u32(palette.desk))
    draw_list.add_rect_filled(place - square, place + square, colour_u32(palette.accent))
    return actions


def _cursor(right: int, down: int) -> imgui.MouseCursor_:
    if not down:
        return imgui.MouseCursor_.resize_ew
    if not right:
        return imgui.MouseCursor_.resize_ns
    return imgui.MouseCursor_.resize_nwse if right == down else imgui.MouseCursor_.resize_nesw
