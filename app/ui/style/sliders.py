"""Sliders with a thin track, and the value in a field beside it, where it stays readable."""

import math
from dataclasses import dataclass
from typing import NamedTuple

from imgui_bundle import ImVec2, ImVec4, imgui

from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import FILL, draw_tooltip

FIELD = 4.3  # em
BAR, KNOB = 0.28, 0.42  # em: thickness of the track, radius of the knob


class SliderEdit(NamedTuple):
    """An entered value. While the knob is dragged, the value is not final."""

    value: float
    is_final: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Scale:
    """The range of a slider's track, from its left to its right end. The left end may be larger.

    On a logarithmic track, equal distances are equal ratios.
    """

    left: float
    right: float
    logarithmic: bool = False

    def share(self, value: float) -> float:
        """Return the position of a value on the track, 0 to 1."""
        low, high, value = (self._straight(x) for x in (self.left, self.right, self.clamp(value)))
        return (value - low) / (high - low)

    def value(self, share: float) -> float:
        """Return the value at a position on the track, 0 to 1."""
        low, high = self._straight(self.left), self._straight(self.right)
        value = low + min(max(share, 0.0), 1.0) * (high - low)
        return math.exp(value) if self.logarithmic else value

    def clamp(self, value: float) -> float:
        low, high = sorted((self.left, self.right))
        return min(max(value, low), high)

    def _straight(self, value: float) -> float:
        return math.log(value) if self.logarithmic else value


def slider(
    look: Look,
    name: str,
    value: float,
    scale: Scale,
    *,
    text: str = "%.2f",
    hint: str = "",
    field: float = FIELD,
    room: float = 0.0,
) -> SliderEdit | None:
    """Draw a track with a knob and a value field, over the rest of the line's width.

    Parameters
    ----------
    name : str
        Id of the field; the track's is `name track`.
    text : str
        C format of the number.
    hint : str
        Tooltip of both.
    field : float
        Width of the field, in em.
    room : float
        Room at the end of the line, in pixels.
    """
    gap = imgui.get_style().item_inner_spacing.x
    width = imgui.get_content_region_avail().x - field * look.em - gap - room
    moved = slider_track(look, f"{name} track", value, scale, width, colour=look.palette.accent)
    draw_tooltip(hint)
    imgui.same_line(0, gap)
    imgui.set_next_item_width(-room if room else FILL)
    entered = number_field(name, value, text)
    draw_tooltip(hint)
    return moved if entered is None else SliderEdit(scale.clamp(entered), is_final=True)


def number_field(name: str, value: float, text: str = "%.2f") -> float | None:
    """Draw a field for a number. Return the number when a different one was entered."""
    _, entered = imgui.input_float(f"##{name}", value, 0.0, 0.0, text)
    done = imgui.is_item_deactivated_after_edit()
    return entered if done and math.isfinite(entered) and entered != value else None


def slider_track(
    look: Look,
    name: str,
    value: float,
    scale: Scale,
    width: float,
    *,
    colour: ImVec4,
    used: float | None = None,
) -> SliderEdit | None:
    """Draw a thin track with a knob that can be dragged.

    Parameters
    ----------
    width : float
        Pixels.
    colour : ImVec4
        Of the filled part of the track.
    used : float, optional
        End of the filled part; by default the knob.
    """
    palette, draw_list = look.palette, imgui.get_window_draw_list()
    corner, height = imgui.get_cursor_screen_pos(), imgui.get_frame_height()
    knob, bar = KNOB * look.em, BAR * look.em
    imgui.invisible_button(name, ImVec2(max(width, 4 * knob), height))
    is_held = imgui.is_item_active()
    low, high = corner.x + knob, corner.x + max(width, 4 * knob) - knob
    middle = corner.y + height / 2
    edit = None
    if is_held or imgui.is_item_deactivated():
        share = (imgui.get_mouse_pos().x - low) / (high - low)
        # In the frame of the press, another widget may have finished its own edit.
        if not imgui.is_item_activated():
            edit = SliderEdit(scale.value(share), is_final=not is_held)
            value = edit.value
    place = low + scale.share(value) * (high - low)
    end = place if used is None else low + scale.share(used) * (high - low)
    top, bottom = middle - bar / 2, middle + bar / 2
    draw_list.add_rect_filled(
        ImVec2(low - bar, top), ImVec2(high + bar, bottom), colour_u32(palette.pressed), bar / 2
    )
    draw_list.add_rect_filled(
        ImVec2(low - bar, top), ImVec2(end, bottom), colour_u32(colour), bar / 2
    )
    is_hot = is_held or imgui.is_item_hovered()
    draw_list.add_circle_filled(ImVec2(place, middle), knob + bar / 2, colour_u32(palette.panel))
    draw_list.add_circle_filled(
        ImVec2(place, middle), knob, colour_u32(palette.accent if is_hot else palette.text)
    )
    return edit
