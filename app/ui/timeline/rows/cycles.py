"""The repeats of cycles: hatched, with seams and repeated keys. Their ends can be dragged."""

from bisect import bisect_left

from imgui_bundle import ImVec2, imgui

from app.document import Cycle, Keyframe, Layer
from app.editor import Action, CycleDrag, do
from app.editor.actions.timing import timeline_drag
from app.texts import _
from app.ui.style.theme import colour_u32
from app.ui.style.widgets import begin_tooltip, is_hovered_or_held, is_pressed
from app.ui.timeline.layout import LEAST_MARK_GAP, TimelineLayout, draw_time_tag
from app.ui.timeline.row import LayerRow

HATCH = 0.55  # em: between the lines over repeats
GRIP = 0.35  # em: half the hit width of the end of repeats
REPEATED_KEY = 0.26  # em: radius of a repeated key
SEAM = 0.2  # em: smallest distance of two seams


def draw_cycle_bars(bands: TimelineLayout) -> list[Action]:
    """Draw the repeats of all layers, and handle the pointer on their ends."""
    actions: list[Action] = []
    bands.push_track_clip()
    for row in filter(bands.shows_row, bands.rows):
        for cycle in row.layer.cycles:
            end = bands.project.document.frames.last if cycle.until is None else cycle.until
            _hatch(bands, row, cycle, end)
            if row.is_active:
                actions += _ends_of_cycle(bands, row, cycle, end)
    imgui.pop_clip_rect()
    return actions


def _hatch(bands: TimelineLayout, row: LayerRow, cycle: Cycle, end: int) -> None:
    """Hatch the repeats of a cycle, with seams and repeated keys."""
    draw_list, em, accent = imgui.get_window_draw_list(), bands.look.em, bands.look.palette.accent
    left, right = max(bands.x(cycle.last), bands.left), min(bands.x(end), bands.right)
    if right <= left:
        return
    half = (bands.bar_bottom - bands.bar_top if row.is_active else row.bottom - row.top) / 2 - 1
    low, high = ImVec2(left, row.middle - half), ImVec2(right, row.middle + half)
    draw_list.add_rect_filled(low, high, colour_u32(accent, 0.07))
    imgui.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    # The lines move with time when the timeline is scrolled.
    first, gap = bands.x(0), HATCH * em
    x = first + ((left - first) // gap) * gap
    while x < right + 2 * half:
        draw_list.add_line(ImVec2(x, low.y), ImVec2(x - 2 * half, high.y), colour_u32(accent, 0.28))
        x += gap
    # One seam stands for several that are closer than SEAM.
    step = cycle.period * max(round(SEAM / (cycle.period * bands.time_view.scale)), 1)
    before = max(int(bands.frame(bands.left) - cycle.last) // step, 0) * step
    until = min(end, int(bands.frame(bands.right)) + 1)
    own = _closest_keys(row.layer, cycle, LEAST_MARK_GAP / bands.time_view.scale)
    for start in range(cycle.last + before, until + 1, step):
        x = bands.x(start)
        draw_list.add_line(ImVec2(x, low.y), ImVec2(x, high.y), colour_u32(accent, 0.6))
        for frame in own if cycle.period * bands.time_view.scale > 1 else ():
            again = bands.x(start + frame - cycle.first)
            if bands.shows(again - em, again + em):
                colour = colour_u32(bands.look.palette.dim, 0.9)
                draw_list.add_circle(ImVec2(again, row.middle), REPEATED_KEY * em, colour, 0, 1.5)
    imgui.pop_clip_rect()


def _closest_keys(layer: Layer, cycle: Cycle, apart: float) -> list[int]:
    """Return the frames of a cycle's keys, without keys closer than `apart` to the one before."""
    frames, at = list[int](), bisect_left(layer.keys, cycle.first, key=_frame)
    while at < len(layer.keys) and layer.keys[at].frame < cycle.last:
        frames.append(layer.keys[at].frame)
        at = bisect_left(layer.keys, frames[-1] + apart, at + 1, key=_frame)
    return frames


def _frame(key: Keyframe) -> int:
    return key.frame


def _ends_of_cycle(bands: TimelineLayout, row: LayerRow, cycle: Cycle, end: int) -> list[Action]:
    """Draw the ends of a cycle and of its repeats, and handle the pointer on them."""
    if cycle.until is None:
        text = _("Frames {first} to {last} repeat to the end of the scene")
    else:
        text = _("Frames {first} to {last} repeat until frame {until}")
    text = text.format(first=cycle.first, last=cycle.last, until=end)
    actions: list[Action] = []
    if end > cycle.last:
        actions += _end_of_cycle(bands, row, cycle, cycle.last, text, is_stretch=True)
    return actions + _end_of_cycle(bands, row, cycle, end, text, is_stretch=False)


def _end_of_cycle(
    bands: TimelineLayout, row: LayerRow, cycle: Cycle, end: int, text: str, *, is_stretch: bool
) -> list[Action]:
    x, half = bands.x(end), GRIP * bands.look.em
    if not bands.shows(x - half, x + half):
        return []
    gesture = bands.project.timeline.gesture
    is_dragged = isinstance(gesture, CycleDrag) and (gesture.first, gesture.is_stretch) == (
        cycle.first,
        is_stretch,
    )
    low, high = ImVec2(x - half, bands.bar_top), ImVec2(x + half, bands.bar_bottom)
    bands.button(f"{'stretch' if is_stretch else 'repeats'} of {cycle.first}", low, high)
    is_hot = is_hovered_or_held() or is_dragged
    colour = colour_u32(bands.look.palette.accent, 1.0 if is_hot else 0.75)
    draw_list, top, bottom = imgui.get_window_draw_list(), bands.bar_top, bands.bar_bottom
    draw_list.add_line(ImVec2(x, top), ImVec2(x, bottom), colour, 3.0 if is_hot else 2.0)
    for y in () if is_stretch else (top, bottom):
        draw_list.add_line(ImVec2(x - half, y), ImVec2(x, y), colour, 2.0)
    if is_hot:
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
    if is_dragged:
        tag = _("to {frame}") if is_stretch else _("until {frame}")
        is_open = cycle.until is None and not is_stretch
        draw_time_tag(bands, x, _("to the end") if is_open else tag.format(frame=end))
    elif gesture is None and begin_tooltip():
        imgui.text_unformatted(text)
        imgui.text_disabled(
            _("Drag to make each repeat longer or shorter, right-click the repeats for more")
            if is_stretch
            else _("Drag to change where the repeats end, right-click the repeats for more")
        )
        imgui.end_tooltip()
    if not is_pressed():
        return []
    drag = CycleDrag(
        layer=row.layer.id,
        first=cycle.first,
        is_stretch=is_stretch,
        start=bands.pointed,
    )
    return [do(timeline_drag.begin_timeline_drag, drag, bands.time_view)]
