"""The way from key to key: a bar with its easing curve, which opens the easing's editor."""

from dataclasses import dataclass

from imgui_bundle import ImVec2, imgui

from app.document import HOLD, LINEAR, Keyframe, Transit, closing_span, spans, transits
from app.editor import Action, do
from app.editor.actions import tracks
from app.ui.style import SMALL, in_hand, ink, is_pressed, sized, tip
from app.ui.timeline.bands import ROUNDING, Bands
from app.ui.timeline.easing_curve import draw_curve, easing_popup, fill_curve
from app.ui.timeline.keys import begin_box, is_plain_click

LEAST = 0.6  # em: narrower bars are not drawn
INSET = 0.35  # em: between the curve and the bar's edge
NAMES = {"linear": "linear", "in": "ease in", "out": "ease out", "in-out": "ease in-out"}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Bar:
    """A stretch of an interval; that of a loop's last one begins and ends elsewhere."""

    name: str
    key: Keyframe
    begin: float
    end: float
    low: float
    high: float
    way: Transit

    @property
    def told(self) -> str:
        """How time runs in it, in words: by its easing, or by how its keys are passed."""
        easing = self.key.easing
        if easing == LINEAR and not self.way.is_even:
            return "smooth"
        return NAMES.get(easing.name, easing.name)


def draw_intervals(bands: Bands) -> list[Action]:
    """Draw all bars; a click on one opens its easing."""
    actions: list[Action] = []
    bands.push_clip()
    _draw_still(bands)
    for bar in _bars(bands):
        left, right = bands.x(bar.low), bands.x(bar.high)
        if right - left >= LEAST * bands.look.em and bands.shows(left, right):
            actions += _interval(bands, bar, left, right)
    imgui.pop_clip_rect()
    return actions


def _bars(bands: Bands) -> list[_Bar]:
    clip, bars = bands.project.clip, list[_Bar]()
    for span, way in zip(spans(clip), transits(clip), strict=True):
        if span.first == span.last:
            continue
        key, end = clip.keys[span.first], span.start + span.frames
        # What goes on from a cycle begins elsewhere than at its key.
        name = f"interval {key.frame}" + " on" * (span.start != key.frame)
        parts = [(name, 0, span.start, min(end, clip.frames.last))]
        if span == closing_span(clip):
            parts.append((f"{name} again", -clip.period, clip.frames.first, clip.keys[0].frame))
        bars += [
            _Bar(
                name=part,
                key=key,
                begin=span.start + shift,
                end=end + shift,
                low=low,
                high=high,
                way=way,
            )
            for part, shift, low, high in parts
        ]
    return bars


def _draw_still(bands: Bands) -> None:
    """Draw a line where a pose stands still: before the first key and after the last one."""
    clip = bands.project.clip
    ends = [(clip.frames.first, clip.frames.last)]
    if closing_span(clip) is None:
        first, last = clip.keys[0].frame, clip.keys[-1].frame
        ends = [(clip.frames.first, first), (last, clip.frames.last)]
        colour = ink(bands.look.palette.dim, 0.35)
        for low, high in ends:
            imgui.get_window_draw_list().add_line(
                ImVec2(bands.x(low), bands.middle), ImVec2(bands.x(high), bands.middle), colour, 1.5
            )


def _interval(bands: Bands, bar: _Bar, left: float, right: float) -> list[Action]:
    actions: list[Action] = []
    low, high = ImVec2(left + 1, bands.bar_top), ImVec2(right - 1, bands.bar_bottom)
    clicked = bands.button(bar.name, low, high, right=True)
    popup = f"easing {bar.key.frame}"
    if is_pressed():
        actions += begin_box(bands)
    if clicked and is_plain_click():
        actions.append(do(tracks.choose, None))
        imgui.open_popup(popup)
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        actions.append(do(tracks.choose, None))
        imgui.open_popup("menu of track")
    is_open = imgui.is_popup_open(popup)
    hot = is_open or (in_hand() and bands.project.timing.gesture is None)
    if bands.project.timing.gesture is None and not is_open:
        tip(f"{bar.told.capitalize()}: click to change how time runs here")
    _draw_bar(bands, bar, low, high, hot=hot)
    _label(bands, bar.told, bar.key.turns, low, high)
    if bar.name.split()[-1].isdecimal():
        actions += easing_popup(popup, bands.look, bands.project, bar.key)
    return actions


def _draw_bar(bands: Bands, bar: _Bar, low: ImVec2, high: ImVec2, *, hot: bool) -> None:
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    rounding = ROUNDING / 2 * em
    chosen = bar.key.frame in bands.project.chosen
    colour = palette.accent if hot or chosen else palette.dim
    if bar.key.easing == HOLD:
        draw_list.add_rect_filled(low, high, ink(palette.raised, 0.35), rounding)
        draw_list.add_rect(low, high, ink(colour, 0.45), rounding, 1.0)
    else:
        draw_list.add_rect_filled(
            low, high, ink(palette.hovered if hot else palette.raised), rounding
        )
    inset = INSET * em
    corner = ImVec2(bands.x(bar.begin), low.y + inset)
    size = ImVec2(bands.x(bar.end) - corner.x, high.y - low.y - 2 * inset)
    draw_list.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    if bar.key.easing != HOLD:
        fill_curve(bar.key.easing, corner, size, inset, ink(colour, 0.30 if hot else 0.16))
    draw_curve(bar.key.easing, corner, size, ink(colour, 0.95 if hot or chosen else 0.7), 0.1 * em)
    draw_list.pop_clip_rect()


def _label(bands: Bands, name: str, turns: int, low: ImVec2, high: ImVec2) -> None:
    """Name the easing in the upper left corner, where its curve is not yet."""
    em = bands.look.em
    text = f"{name}, {turns:+d} turns" if abs(turns) > 1 else f"{name}, {turns:+d} turn"
    text = text if turns else name
    left = max(low.x, bands.left) + 0.6 * em
    with sized(SMALL):
        if left + 2.2 * imgui.calc_text_size(text).x + em < min(high.x, bands.right):
            place, colour = (left, low.y + 0.25 * em), ink(bands.look.palette.dim)
            imgui.get_window_draw_list().add_text(place, colour, text)
