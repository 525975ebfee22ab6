"""The ring around the selected handle, by which the shape is turned there."""

import math
from typing import NamedTuple

from imgui_bundle import ImVec2, imgui

from app.ui.style import Look, ink

RADIUS, BAND, KNOB = 2.2, 0.5, 0.3  # em: of the ring, of where the pointer takes it, of its knob


class Ring(NamedTuple):
    """Where the ring is.

    Parameters
    ----------
    centre : ImVec2
        On the screen.
    turn : float
        How far the shape is turned there, in radians.
    is_held : bool
        Whether the pointer turns it.
    swept : float
        How far it has turned it, in radians.
    """

    centre: ImVec2
    turn: float
    is_held: bool
    swept: float

    def is_pointed(self, look: Look) -> bool:
        """Tell whether the pointer is on it."""
        mouse = imgui.get_mouse_pos()
        distance = math.hypot(mouse.x - self.centre.x, mouse.y - self.centre.y)
        return abs(distance - RADIUS * look.em) < BAND * look.em


def draw_ring(look: Look, ring: Ring, *, is_pointed: bool) -> None:
    """Draw the ring with a knob where the turned shape's up is; while it is held, the angle."""
    draw_list, palette, em = imgui.get_window_draw_list(), look.palette, look.em
    is_hot = is_pointed or ring.is_held
    colour = palette.accent if is_hot else palette.text
    # Dark below light, so that it shows on any drawing.
    for ink_, width in (
        (ink(palette.desk, 0.5), 0.26),
        (ink(colour, 1.0 if is_hot else 0.55), 0.12),
    ):
        draw_list.add_circle(ring.centre, RADIUS * em, ink_, 64, width * em)
    up = ring.turn + math.pi / 2
    knob = ImVec2(
        ring.centre.x + RADIUS * em * math.cos(up), ring.centre.y - RADIUS * em * math.sin(up)
    )
    if ring.is_held:
        draw_list.add_line(ring.centre, knob, ink(colour), 0.12 * em)
    draw_list.add_circle_filled(knob, (KNOB + 0.1) * em, ink(palette.desk, 0.7))
    draw_list.add_circle_filled(knob, KNOB * em, ink(colour))
    if is_hot:
        imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
    if ring.is_held:
        _write_angle(look, ring)


def _write_angle(look: Look, ring: Ring) -> None:
    degrees = round(math.degrees(ring.swept))
    text = f"{degrees:+d}°".replace("-", "−") if degrees else "0°"
    size, em = imgui.calc_text_size(text), look.em
    low = ImVec2(ring.centre.x - size.x / 2 - 0.5 * em, ring.centre.y - (RADIUS + 2.2) * em)
    high = ImVec2(low.x + size.x + em, low.y + 1.4 * em)
    draw_list = imgui.get_window_draw_list()
    draw_list.add_rect_filled(low, high, ink(look.palette.accent), 0.3 * em)
    place = ImVec2(low.x + 0.5 * em, low.y + (1.4 * em - size.y) / 2)
    draw_list.add_text(place, ink(look.palette.on_accent), text)
