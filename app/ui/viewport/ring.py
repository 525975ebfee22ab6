"""The ring around the selected handle, by which the shape is turned there."""

import math
from typing import NamedTuple

from imgui_bundle import ImVec2, imgui

from app.ui.style import Look, draw_knob, ink, outlined, tag_size, write_tag

RADIUS, BAND, KNOB = 2.2, 0.5, 0.3  # em: of the ring, of where the pointer takes it, of its knob
LINE = 0.12  # em


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
    draw_list, radius = imgui.get_window_draw_list(), RADIUS * look.em
    is_hot = is_pointed or ring.is_held
    colour = look.palette.accent if is_hot else look.palette.text
    for tone, width in outlined(look, ink(colour, 1.0 if is_hot else 0.55), LINE):
        draw_list.add_circle(ring.centre, radius, tone, 64, width)
    up = ring.turn + math.pi / 2
    knob = ring.centre + ImVec2(radius * math.cos(up), -radius * math.sin(up))
    if ring.is_held:
        draw_list.add_line(ring.centre, knob, ink(colour), LINE * look.em)
    draw_knob(look, knob, KNOB, colour)
    if is_hot:
        imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
    if ring.is_held:
        _write_angle(look, ring)


def _write_angle(look: Look, ring: Ring) -> None:
    degrees = round(math.degrees(ring.swept))
    text = f"{degrees:+d}°".replace("-", "−") if degrees else "0°"
    above = ImVec2(tag_size(look, text).x / 2, (RADIUS + 2.2) * look.em)
    write_tag(look, ring.centre - above, text)
