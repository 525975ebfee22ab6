"""Segment bars with easing curves. A click on a bar opens its easing."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from imgui_bundle import ImVec2, imgui

from app.document import (
    HOLD,
    LINEAR,
    Keyframe,
    PoseSegment,
    Segment,
    clip_segments,
    loop_segment,
    pose_segments,
)
from app.editor import Action, do
from app.editor.actions.timing import tracks
from app.texts import _, ngettext
from app.ui.style.theme import SMALL, colour_u32
from app.ui.style.widgets import (
    draw_tooltip,
    is_hovered_or_held,
    is_pressed,
    push_text_size,
)
from app.ui.timeline.easing_curve import draw_easing_curve, draw_easing_popup, fill_easing_curve
from app.ui.timeline.layout import ROUNDING, TimelineLayout
from app.ui.timeline.menus import TRACK_MENU
from app.ui.timeline.rows.background import begin_key_box, is_plain_click

LEAST = 0.6  # em: narrower bars are not drawn
INSET = 0.35  # em: between the curve and the bar's edge
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
        actions.append(do(tracks.select_channel, None))
        imgui.open_popup(popup)
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        actions.append(do(tracks.select_channel, None))
        imgui.open_popup(TRACK_MENU)
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
    chosen = bar.key.frame in bands.project.selection.frames
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
