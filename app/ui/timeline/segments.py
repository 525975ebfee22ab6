"""Segment bars with easing curves, and hatched repeats of cycles.

A click on a bar opens its easing. The end of repeats can be dragged.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from imgui_bundle import ImVec2, imgui

from app.document import (
    HOLD,
    LINEAR,
    Cycle,
    Keyframe,
    Layer,
    PoseSegment,
    Segment,
    clip_segments,
    loop_segment,
    pose_segments,
)
from app.editor import Action, CycleDrag, do
from app.editor.actions.timing import timeline_drag, tracks
from app.texts import _, ngettext
from app.ui.style.theme import SMALL, colour_u32
from app.ui.style.widgets import (
    begin_tooltip,
    draw_tooltip,
    is_hovered_or_held,
    is_pressed,
    push_text_size,
)
from app.ui.timeline.easing_curve import draw_easing_curve, draw_easing_popup, fill_easing_curve
from app.ui.timeline.keys import begin_key_box, is_plain_click
from app.ui.timeline.layout import LEAST_MARK_GAP, ROUNDING, LayerRow, TimelineLayout, draw_time_tag

LEAST = 0.6  # em: narrower bars are not drawn
INSET = 0.35  # em: between the curve and the bar's edge
HATCH = 0.55  # em: between the lines over repeats
GRIP = 0.35  # em: half the hit width of the end of repeats
REPEATED_KEY = 0.26  # em: radius of a repeated key
SEAM = 0.2  # em: smallest distance of two seams
NAMES = {
    "linear": _("linear"),
    "in": _("ease in"),
    "out": _("ease out"),
    "in-out": _("ease in-out"),
    "hold": _("hold"),
    "custom": _("custom"),
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _SegmentBar:
    """A segment's bar. The last segment of a loop has two bars, before and after the loop's end."""

    name: str
    key: Keyframe
    begin: float
    end: float
    low: float
    high: float
    segment: PoseSegment

    @property
    def easing_text(self) -> str:
        """The easing of the segment in words, or "smooth"."""
        easing = self.key.easing
        if easing == LINEAR and not self.segment.is_linear:
            return _("smooth")
        return NAMES[easing.name]


def draw_pose_segments(bands: TimelineLayout) -> list[Action]:
    """Draw the visible bars of pose segments. A click on a bar opens its easing."""
    actions: list[Action] = []
    bands.push_track_clip()
    _draw_still(bands)
    for bar in _bars(bands):
        left, right = bands.x(bar.low), bands.x(bar.high)
        if right - left >= LEAST * bands.look.em and bands.shows(left, right):
            actions += _draw_segment(bands, bar, left, right)
    imgui.pop_clip_rect()
    return actions


def _bars(bands: TimelineLayout) -> list[_SegmentBar]:
    clip, bars = bands.project.clip, list[_SegmentBar]()
    ways, laid = pose_segments(clip), clip_segments(clip)
    for span, way in ((laid[number], ways[number]) for number in _in_view(bands, laid)):
        if span.first == span.last:
            continue
        key, end = clip.keys[span.first], span.start + span.frames
        # A segment that continues a cycle does not begin at its key's frame.
        name = f"interval {key.frame}" + " on" * (span.start != key.frame)
        parts = [(name, 0, span.start, min(end, clip.frames.last))]
        if span == loop_segment(clip):
            parts.append((f"{name} again", -clip.period, clip.frames.first, clip.keys[0].frame))
        bars += [
            _SegmentBar(
                name=part,
                key=key,
                begin=span.start + shift,
                end=end + shift,
                low=low,
                high=high,
                segment=way,
            )
            for part, shift, low, high in parts
        ]
    return bars


def _in_view(bands: TimelineLayout, laid: Sequence[Segment]) -> Iterator[int]:
    """Yield the indices of segments in view, without those too narrow to be drawn."""
    number = max(bisect_right(laid, bands.frame(bands.left), key=_start) - 1, 0)
    end = bisect_left(laid, bands.frame(bands.right), key=_start)
    while number < end:
        yield number
        # The last segment that begins within a narrow one may be wide.
        narrow = laid[number].start + LEAST / bands.time_view.scale
        number = max(number + 1, bisect_right(laid, narrow, number, end, key=_start) - 1)
    if laid and end < len(laid):
        # The last segment of a loop continues before the first key.
        yield len(laid) - 1


def _start(span: Segment) -> int:
    return span.start


def _draw_still(bands: TimelineLayout) -> None:
    """Draw a line where the pose is constant: before the first key and after the last key."""
    clip = bands.project.clip
    ends = [(clip.frames.first, clip.frames.last)]
    if loop_segment(clip) is None:
        first, last = clip.keys[0].frame, clip.keys[-1].frame
        ends = [(clip.frames.first, first), (last, clip.frames.last)]
        colour = colour_u32(bands.look.palette.dim, 0.35)
        for low, high in ends:
            imgui.get_window_draw_list().add_line(
                ImVec2(bands.x(low), bands.middle), ImVec2(bands.x(high), bands.middle), colour, 1.5
            )


def _draw_segment(
    bands: TimelineLayout, bar: _SegmentBar, left: float, right: float
) -> list[Action]:
    actions: list[Action] = []
    low, high = ImVec2(left + 1, bands.bar_top), ImVec2(right - 1, bands.bar_bottom)
    clicked = bands.button(bar.name, low, high, right=True)
    popup = f"easing {bar.key.frame}"
    if is_pressed():
        actions += begin_key_box(bands)
    if clicked and is_plain_click():
        actions.append(do(tracks.select_track, None))
        imgui.open_popup(popup)
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        actions.append(do(tracks.select_track, None))
        imgui.open_popup("menu of track")
    is_open = imgui.is_popup_open(popup)
    hot = is_open or (is_hovered_or_held() and bands.project.timeline.gesture is None)
    if bands.project.timeline.gesture is None and not is_open:
        draw_tooltip(_("Easing: {easing}. Click to change it.").format(easing=bar.easing_text))
    _draw_bar(bands, bar, low, high, hot=hot)
    _label(bands, bar.easing_text, bar.key.revolutions, low, high)
    if bar.name.split()[-1].isdecimal():
        actions += draw_easing_popup(popup, bands.look, bands.project, bar.key)
    return actions


def _draw_bar(
    bands: TimelineLayout, bar: _SegmentBar, low: ImVec2, high: ImVec2, *, hot: bool
) -> None:
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    rounding = ROUNDING / 2 * em
    chosen = bar.key.frame in bands.project.selected_frames
    colour = palette.accent if hot or chosen else palette.dim
    if bar.key.easing == HOLD:
        draw_list.add_rect_filled(low, high, colour_u32(palette.raised, 0.35), rounding)
        draw_list.add_rect(low, high, colour_u32(colour, 0.45), rounding, 1.0)
    else:
        draw_list.add_rect_filled(
            low, high, colour_u32(palette.hovered if hot else palette.raised), rounding
        )
    inset = INSET * em
    corner = ImVec2(bands.x(bar.begin), low.y + inset)
    size = ImVec2(bands.x(bar.end) - corner.x, high.y - low.y - 2 * inset)
    draw_list.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    if bar.key.easing != HOLD:
        fill_easing_curve(
            bar.key.easing, corner, size, inset, colour_u32(colour, 0.30 if hot else 0.16)
        )
    draw_easing_curve(
        bar.key.easing, corner, size, colour_u32(colour, 0.95 if hot or chosen else 0.7), 0.1 * em
    )
    draw_list.pop_clip_rect()


def _label(bands: TimelineLayout, name: str, turns: int, low: ImVec2, high: ImVec2) -> None:
    """Write the easing's name in the upper left corner, away from the curve."""
    em = bands.look.em
    text = ngettext("{easing}, {turns:+d} turn", "{easing}, {turns:+d} turns", abs(turns))
    text = text.format(easing=name, turns=turns) if turns else name
    left = max(low.x, bands.left) + 0.6 * em
    with push_text_size(SMALL):
        if left + 2.2 * imgui.calc_text_size(text).x + em < min(high.x, bands.right):
            place, colour = (left, low.y + 0.25 * em), colour_u32(bands.look.palette.dim)
            imgui.get_window_draw_list().add_text(place, colour, text)


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
            _("Drag to make each repeat longer or shorter, right click the repeats for more")
            if is_stretch
            else _("Drag to end the repeats elsewhere, right click the repeats for more")
        )
        imgui.end_tooltip()
    if not is_pressed():
        return []
    drag = CycleDrag(
        layer=row.layer.id,
        first=cycle.first,
        is_stretch=is_stretch,
        start=bands.pointed,
        before=bands.project.document,
        after=bands.project.document,
    )
    return [do(timeline_drag.begin_timeline_drag, drag, bands.time_view)]
