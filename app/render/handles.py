"""The look of handles: from their states to lines and discs."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.render.scene import TRANSPARENT, Colour, Disc, Line

NORMAL: Final[Colour] = (0.16, 0.42, 0.95, 1.0)
SELECTED: Final[Colour] = (1.00, 0.66, 0.10, 1.0)
ANCHOR: Final[Colour] = (0.05, 0.80, 0.90, 1.0)
LOCKED: Final[Colour] = (0.33, 0.36, 0.42, 1.0)
TARGET: Final[Colour] = (1.00, 0.33, 0.18, 1.0)
RIM: Final[Colour] = (1.00, 1.00, 1.00, 1.0)
HALO: Final[Colour] = (1.00, 1.00, 1.00, 0.55)
SHADOW: Final[Colour] = (0.00, 0.00, 0.00, 0.45)
# Pixels at the interface's scale of 1.
RADIUS, RIM_WIDTH, BLUR = 7.0, 2.0, 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class HandleMark:
    """The state of a drawn handle."""

    place: complex  # position of the handle, in the plane
    target: complex | None = None  # its target, if the limits make it unreachable
    anchor: bool = False
    selected: bool = False
    hovered: bool = False
    locked: bool = False


def mark_handles(
    marks: Sequence[HandleMark], *, scale: float = 1.0
) -> tuple[tuple[Line, ...], tuple[Disc, ...]]:
    """Return the lines and discs of handles at the interface's scale; later ones on top."""
    lines: list[Line] = []
    discs: list[Disc] = []
    for mark in marks:
        if mark.target is not None:
            way = np.array([mark.target, mark.place])
            lines += [
                # A shadow under white, so that the dashes are visible on a drawing of their own
                # colour.
                Line(points=way, colour=SHADOW, width=4.5 * scale),
                Line(points=way, colour=RIM, width=2.5 * scale),
                Line(points=way, colour=TARGET, width=2.5 * scale, dash=5.0 * scale),
            ]
            discs.append(_shadow(mark.target, 0.75 * RADIUS, scale))
            discs.append(_disc(mark.target, 0.75 * RADIUS, scale, fill=RIM, rim=TARGET))
        discs += _pin(mark, scale)
    return tuple(lines), tuple(discs)


def mark_anchor(place: complex, *, scale: float = 1.0) -> tuple[Disc, ...]:
    """Return the discs of an anchor without a handle; smaller than a handle's."""
    dot = _disc(place, 0.6 * RADIUS, scale, fill=ANCHOR, rim=RIM, rim_width=0.75 * RIM_WIDTH)
    return _shadow(place, 0.6 * RADIUS, scale), dot


def _pin(mark: HandleMark, scale: float) -> list[Disc]:
    place, radius = mark.place, RADIUS * (1.25 if mark.hovered else 1.0)
    usual = LOCKED if mark.locked else NORMAL
    body = ANCHOR if mark.anchor else SELECTED if mark.selected else usual
    ring = radius + 1.75 * RIM_WIDTH if mark.selected else radius
    discs = [_shadow(place, ring, scale)]
    if mark.hovered:
        halo = radius + (4.0 if mark.selected else 2.5) * RIM_WIDTH
        discs.insert(0, _disc(place, halo, scale, fill=HALO))
    if mark.selected:
        discs.append(_disc(place, ring, scale, fill=SELECTED))
    discs.append(_disc(place, radius, scale, fill=body, rim=RIM))
    if mark.anchor:
        discs.append(_disc(place, 0.35 * radius, scale, fill=RIM))
    elif mark.locked and mark.selected:
        discs.append(_disc(place, 0.45 * radius, scale, fill=LOCKED))
    return discs


def _disc(
    centre: complex,
    radius: float,
    scale: float,
    *,
    fill: Colour,
    rim: Colour = TRANSPARENT,
    rim_width: float = RIM_WIDTH,
) -> Disc:
    width = 0.0 if rim is TRANSPARENT else rim_width * scale
    return Disc(centre=centre, radius=radius * scale, fill=fill, rim=rim, rim_width=width)


def _shadow(centre: complex, radius: float, scale: float) -> Disc:
    size = (radius + 0.5) * scale
    return Disc(centre=centre, radius=size, fill=SHADOW, softness=BLUR * scale)
