"""The ruler with frames and seconds, the playhead, and the overview below the tracks."""

from imgui_bundle import ImVec2, imgui

from app.document import Layer, memoized_on
from app.editor import Action, ScrubDrag, do
from app.editor.actions.timing import timeline_drag
from app.ui.style.drawing import draw_centred_text
from app.ui.style.theme import SMALL, colour_u32
from app.ui.style.widgets import is_hovered_or_held, is_pressed, push_text_size
from app.ui.timeline.layout import TimelineLayout, format_seconds

TICK_ROOM = 0.55  # em: smallest distance of small ticks
RULER_TAG = 1.2  # em: height of the playhead's number
LABEL_GAP = 2.4  # em: smallest distance of labels
MULTIPLES = (2, 5, 10, 30, 60, 120, 300, 600, 1800, 3600, 7200, 18000)


def draw_ruler(bands: TimelineLayout, frame: int) -> list[Action]:
    """Draw frame numbers and seconds. A press moves the playhead."""
    bands.button(
        "ruler", ImVec2(bands.left, bands.ruler_top), ImVec2(bands.right, bands.markers_top)
    )
    bands.look.note_place("ruler")
    actions: list[Action] = []
    if is_pressed():
        actions += [
            do(timeline_drag.begin_timeline_drag, ScrubDrag(), bands.time_view),
            do(timeline_drag.move_timeline_drag, bands.pointed, bands.pointed_channel),
        ]
    if imgui.is_item_hovered():
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
    draw_list = imgui.get_window_draw_list()
    low, high = ImVec2(bands.left, bands.ruler_top), ImVec2(bands.right, bands.track_bottom)
    draw_list.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    with push_text_size(SMALL):
        _draw_ticks(bands, frame)
    draw_list.pop_clip_rect()
    return actions


def _draw_ticks(bands: TimelineLayout, present: int) -> None:
    """Draw ticks, and their labels unless the playhead covers them."""
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    document = bands.project.document
    per_frame = bands.time_view.scale * em
    last = max(int(bands.frame(bands.right)) + 1, 0)
    widest = imgui.calc_text_size(f"{last}  {format_seconds(last, document.fps)}").x
    steps = _steps(document.fps)
    large = next((s for s in steps if s * per_frame > widest + LABEL_GAP * em), steps[-1])
    small = next(
        s for s in steps if large % s == 0 and (s == large or s * per_frame >= TICK_ROOM * em)
    )
    begin = max(int(bands.frame(bands.left)) // large * large, 0)
    text, dim, faint = (
        colour_u32(palette.text, 0.85),
        colour_u32(palette.dim),
        colour_u32(palette.dim, 0.5),
    )
    grid = colour_u32(palette.line, 0.55)
    bottom = bands.markers_top - 0.2 * em
    tag = _tag_width(bands, present) / 2 + 0.2 * em
    covered = bands.x(present) - tag, bands.x(present) + tag
    for frame in range(begin, last + 1, small):
        x = bands.x(frame)
        if frame % large:
            draw_list.add_line(ImVec2(x, bottom - 0.35 * em), ImVec2(x, bottom), faint)
            continue
        draw_list.add_line(ImVec2(x, bands.ruler_top + 0.15 * em), ImVec2(x, bottom), dim)
        draw_list.add_line(ImVec2(x, bands.track_top), ImVec2(x, bands.track_bottom), grid)
        number, top = f"{frame}", bands.ruler_top + 0.1 * em
        seconds = format_seconds(frame, document.fps)
        wide = 0.7 * em + imgui.calc_text_size(number).x + imgui.calc_text_size(seconds).x
        if x < covered[1] and x + wide > covered[0]:
            continue
        draw_list.add_text(ImVec2(x + 0.3 * em, top), text, number)
        beside = x + 0.7 * em + imgui.calc_text_size(number).x
        draw_list.add_text(ImVec2(beside, top), dim, seconds)


def _steps(fps: float) -> list[int]:
    """Return tick distances that divide a second or are whole seconds."""
    second = max(1, round(fps))
    parts = [part for part in range(1, second + 1) if second % part == 0]
    return parts + [second * multiple for multiple in MULTIPLES]


def draw_playhead(bands: TimelineLayout, frame: int) -> list[Action]:
    """Draw the playhead as a line with its frame number on the ruler. It can be dragged."""
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    x = bands.x(frame)
    with push_text_size(SMALL, bands.look.bold):
        width = _tag_width(bands, frame)
    low = ImVec2(x - width / 2, bands.ruler_top + 0.05 * em)
    high = low + ImVec2(width, RULER_TAG * em)
    actions: list[Action] = []
    if bands.shows(low.x, high.x):
        bands.button("playhead", low, high)
        bands.look.note_place("playhead")
        if is_pressed():
            scrub = ScrubDrag(offset=frame - bands.pointed)
            actions.append(do(timeline_drag.begin_timeline_drag, scrub, bands.time_view))
        colour = palette.warning if bands.project.unkeyed_pose is not None else palette.accent
        if is_hovered_or_held():
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        draw_list.push_clip_rect(*bands.bounds, intersect_with_current_clip_rect=True)
        draw_list.add_line(
            ImVec2(x, high.y), ImVec2(x, bands.track_bottom), colour_u32(colour), max(1.5, 0.1 * em)
        )
        draw_list.add_rect_filled(low, high, colour_u32(colour), 0.35 * em)
        half = 0.32 * em
        draw_list.add_triangle_filled(
            ImVec2(x - half, high.y - 0.5),
            ImVec2(x + half, high.y - 0.5),
            ImVec2(x, high.y + half),
            colour_u32(colour),
        )
        with push_text_size(SMALL, bands.look.bold):
            draw_centred_text(low, high, f"{frame}", colour_u32(palette.on_accent))
        draw_list.pop_clip_rect()
    return actions


def _tag_width(bands: TimelineLayout, frame: int) -> float:
    return max(imgui.calc_text_size(f"{frame}").x + 0.9 * bands.look.em, 1.9 * bands.look.em)


@memoized_on
def _frames_apart(layer: Layer, step: int) -> frozenset[int]:
    """Return key frames rounded down to multiples of `step`."""
    return frozenset(key.frame // step * step for key in layer.keys if not layer.still)


def draw_overview(bands: TimelineLayout, frame: int) -> list[Action]:
    """Draw the visible part of all frames below the tracks. Dragging it scrolls."""
    strip, frames, em = bands.time_view, bands.project.document.frames, bands.look.em
    end = strip.frame(bands.width)
    low, high = min(frames.first, strip.start), max(frames.last, end)
    if (
        bands.is_cramped
        or bands.project.timeline.time_range is None
        or high - low <= end - strip.start
    ):
        return []
    palette, draw_list = bands.look.palette, imgui.get_window_draw_list()
    top, bottom = bands.bottom - 0.5 * em, bands.bottom
    per_frame = bands.size.x / (high - low)
    left, right = (bands.left + (at - low) * per_frame for at in (strip.start, end))
    bands.button("overview", ImVec2(left, top), ImVec2(right, bottom))
    rounding = (bottom - top) / 2
    draw_list.add_rect_filled(
        ImVec2(bands.left, top), ImVec2(bands.right, bottom), colour_u32(palette.desk), rounding
    )
    bar = colour_u32(palette.dim if is_hovered_or_held() else palette.pressed)
    draw_list.add_rect_filled(ImVec2(left, top), ImVec2(right, bottom), bar, rounding)
    middle = (top + bottom) / 2
    # Each place once, however many keys it has; the active layer's on top.
    layer = bands.project.layer
    for layers, radius, colour in (
        (tuple(row.layer for row in bands.rows), 0.09 * em, colour_u32(palette.dim)),
        ((layer,), 0.11 * em, colour_u32(palette.text, 0.8)),
    ):
        step = max(round(2 * radius / per_frame), 1)
        for at in frozenset[int]().union(*(_frames_apart(each, step) for each in layers)):
            place, half = (
                ImVec2(bands.left + (at - low) * per_frame, middle),
                ImVec2(radius, radius),
            )
            draw_list.add_rect_filled(place - half, place + half, colour)
    x = bands.left + (frame - low) * per_frame
    draw_list.add_line(ImVec2(x, top), ImVec2(x, bottom), colour_u32(palette.accent), 1.5)
    delta = imgui.get_io().mouse_delta.x
    if imgui.is_item_active() and delta:
        moved = strip.panned(delta / per_frame * strip.scale)
        return [do(timeline_drag.set_time_range, moved.kept_near(frames, bands.width))]
    return []
