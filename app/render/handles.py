"""How handles look: from their states to lines and discs."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.render.scene import Colour, Disc, Line


@dataclass(frozen=True, slots=True, kw_only=True)
class HandleMark:
    """A handle as it is to be shown.

    Parameters
    ----------
    place : complex
        Where the handle is, in the plane.
    wish : complex, optional
        Where it should be, if it is out of reach within the bounds.
    anchor, selected, hovered, locked : bool
    """

    place: complex
    wish: complex | None = None
    anchor: bool = False
    selected: bool = False
    hovered: bool = False
    locked: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class HandleStyle:
    """Colours of handles, and their size in pixels at the interface's scale of 1."""

    normal: Colour = (0.16, 0.42, 0.95, 1.0)
    selected: Colour = (1.00, 0.66, 0.10, 1.0)
    anchor: Colour = (0.05, 0.80, 0.90, 1.0)
    locked: Colour = (0.33, 0.36, 0.42, 1.0)
    wish: Colour = (1.00, 0.33, 0.18, 1.0)
    rim: Colour = (1.00, 1.00, 1.00, 1.0)
    halo: Colour = (1.00, 1.00, 1.00, 0.55)
    shadow: Colour = (0.00, 0.00, 0.00, 0.45)
    radius: float = 7.0
    rim_width: float = 2.0


def mark_handles(
    marks: Sequence[HandleMark], *, scale: float = 1.0, style: HandleStyle | None = None
) -> tuple[tuple[Line, ...], tuple[Disc, ...]]:
    """Return the lines and discs that show the handles; the later ones lie on top.

    Parameters
    ----------
    marks : sequence of HandleMark
    scale : float
        The interface's scale.
    style : HandleStyle, optional
    """
    style = style or HandleStyle()
    lines: list[Line] = []
    discs: list[Disc] = []
    for mark in marks:
        if mark.wish is not None:
            lines += _leash(mark.place, mark.wish, scale, style)
            discs += _wish(mark.wish, scale, style)
        discs += _pin(mark, scale, style)
    return tuple(lines), tuple(discs)


def mark_anchor(
    place: complex, *, scale: float = 1.0, style: HandleStyle | None = None
) -> tuple[Disc, ...]:
    """Return the discs that show an anchor where no handle is; smaller, since it is no handle."""
    style = style or HandleStyle()
    radius, rim_width = 0.6 * style.radius * scale, 0.75 * style.rim_width * scale
    return (
        _shadow(place, radius, scale, style),
        Disc(centre=place, radius=radius, fill=style.anchor, rim=style.rim, rim_width=rim_width),
    )


def _leash(place: complex, wish: complex, scale: float, style: HandleStyle) -> list[Line]:
    way = np.array([wish, place])
    return [
        # On white, so that the dashes are seen on a drawing of their own colour.
        Line(points=way, colour=style.shadow, width=4.5 * scale),
        Line(points=way, colour=style.rim, width=2.5 * scale),
        Line(points=way, colour=style.wish, width=2.5 * scale, dash=5.0 * scale),
    ]


def _wish(wish: complex, scale: float, style: HandleStyle) -> list[Disc]:
    radius = 0.75 * style.radius * scale
    rim_width = style.rim_width * scale
    return [
        _shadow(wish, radius, scale, style),
        Disc(centre=wish, radius=radius, fill=style.rim, rim=style.wish, rim_width=rim_width),
    ]


def _pin(mark: HandleMark, scale: float, style: HandleStyle) -> list[Disc]:
    radius = style.radius * scale * (1.25 if mark.hovered else 1.0)
    rim_width = style.rim_width * scale
    usual = style.locked if mark.locked else style.normal
    body = style.anchor if mark.anchor else style.selected if mark.selected else usual
    discs = []
    if mark.hovered:
        halo = radius + (4.0 if mark.selected else 2.5) * rim_width
        discs.append(Disc(centre=mark.place, radius=halo, fill=style.halo))
    if mark.selected:
        ring = radius + 1.75 * rim_width
        discs.append(_shadow(mark.place, ring, scale, style))
        discs.append(Disc(centre=mark.place, radius=ring, fill=style.selected))
    else:
        discs.append(_shadow(mark.place, radius, scale, style))
    discs.append(
        Disc(centre=mark.place, radius=radius, fill=body, rim=style.rim, rim_width=rim_width)
    )
    if mark.anchor:
        discs.append(Disc(centre=mark.place, radius=0.35 * radius, fill=style.rim))
    elif mark.locked and mark.selected:
        discs.append(Disc(centre=mark.place, radius=0.45 * radius, fill=style.locked))
    return discs


def _shadow(centre: complex, radius: float, scale: float, style: HandleStyle) -> Disc:
    blur = 5.0 * scale
    return Disc(centre=centre, radius=radius + 0.5 * scale, fill=style.shadow, softness=blur)
