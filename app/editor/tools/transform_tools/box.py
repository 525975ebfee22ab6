"""The box around several handles or a layer: its grips, and how their drags change places."""

import cmath
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple, Self

from app.editor.overlay_shapes import (
    AreaShape,
    CircleShape,
    ColourRole,
    KnobShape,
    LineShape,
    OverlayShape,
)
from engine.geometry import Similarity

STEM, KNOB, SQUARE = 2.0, 0.34, 0.32  # em: the knob above the box, its radius, half a scale grip
PIVOT, TICK = 0.9, 0.45  # em: radius of the pivot's ring, and of the cross within
REACH, TURN_REACH = 0.75, 2.2  # em: from a grip, and from a corner outside the box
SHORTEST = 4.0  # em: a shorter side has no grip in its middle
SMALLEST = 0.01  # scale of a drag
CORNERS: tuple[complex, ...] = (-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j)
SIDES: tuple[complex, ...] = (-1, 1, -1j, 1j)


class BoxGrip(NamedTuple):
    """A part of the box that can be dragged.

    `way` is the direction from the middle to a scale grip: of a corner 1+1j, of a side 1 or 1j.
    """

    kind: Literal["pivot", "turn", "scale"]
    way: complex = 0j


@dataclass(frozen=True, slots=True, kw_only=True)
class BoxChange:
    """A change of places around a pivot: scaled along the axes of a box, then turned."""

    pivot: complex
    axis: complex = 1.0 + 0j  # direction of the box's lower side
    scale: complex = 1.0 + 1j  # along the axis, and across it
    turn: float = 0.0  # in radians

    def apply(self, place: complex) -> complex:
        arm = (place - self.pivot) * self.axis.conjugate()
        scaled = complex(arm.real * self.scale.real, arm.imag * self.scale.imag)
        return self.pivot + self.axis * scaled * cmath.exp(1j * self.turn)


@dataclass(frozen=True, slots=True, kw_only=True)
class TransformBox:
    """A box whose sides are upright on the screen.

    Attributes
    ----------
    axis : complex
        Direction of the lower side, of modulus 1.
    low, high : complex
        Opposite corners, along the axis and across it.
    pivot : complex
        The place that its drags keep.
    home : complex
        The pivot's place before it is moved.
    has_sides : bool
        Whether its sides scale one direction alone.
    knob : tuple of complex and int
        The side of the knob that turns, and whether it is outside (1) or inside (-1).
    """

    axis: complex
    low: complex
    high: complex
    pivot: complex
    home: complex
    has_sides: bool = True
    knob: tuple[complex, int] = (1j, 1)

    @classmethod
    def around(cls, places: Sequence[complex], axis: complex, margin: float) -> Self:
        """Return the box around places with a margin; its pivot is in its middle."""
        turned = [place * axis.conjugate() for place in places]
        x, y = [each.real for each in turned], [each.imag for each in turned]
        edge = complex(margin, margin)
        low, high = complex(min(x), min(y)) - edge, complex(max(x), max(y)) + edge
        middle = axis * (low + high) / 2
        return cls(axis=axis, low=low, high=high, pivot=middle, home=middle)

    def place(self, way: complex) -> complex:
        """Return the place in a direction from the middle, as of `BoxGrip`."""
        half = (self.high - self.low) / 2
        arm = complex(way.real * half.real, way.imag * half.imag)
        return self.axis * ((self.low + self.high) / 2 + arm)

    def moved_by(self, motion: Similarity) -> Self:
        """Return the box in other coordinates."""
        factor, size = motion.factor, abs(motion.factor)
        axis = self.axis * factor / size
        shift = motion.shift * axis.conjugate()
        return replace(
            self,
            axis=axis,
            low=self.low * size + shift,
            high=self.high * size + shift,
            pivot=factor * self.pivot + motion.shift,
            home=factor * self.home + motion.shift,
        )

    def knob_place(self, em: float) -> complex:
        way, outside = self.knob
        return self.place(way) + self.axis * way * outside * STEM * em

    def scale_grips(self, em: float) -> Iterator[tuple[complex, complex]]:
        """Yield the direction and the place of each scale grip."""
        size, ways = self.high - self.low, list(CORNERS)
        if self.has_sides:
            across = {1.0: size.imag, 0.0: size.real}  # length of a side, by its direction
            ways += [way for way in SIDES if across[abs(way.real)] > SHORTEST * em]
        yield from ((way, self.place(way)) for way in ways)

    def find_grip(self, place: complex, em: float) -> BoxGrip | None:
        """Return the grip at a place; outside the corners, the box turns."""
        if abs(place - self.pivot) <= PIVOT * em * 1.2:
            return BoxGrip("pivot")
        way, away = min(
            ((way, abs(place - at)) for way, at in self.scale_grips(em)), key=lambda each: each[1]
        )
        if away <= REACH * em:
            return BoxGrip("scale", way)
        if abs(place - self.knob_place(em)) <= REACH * em:
            return BoxGrip("turn")
        at = place * self.axis.conjugate()
        is_inside = self.low.real <= at.real <= self.high.real
        is_inside = is_inside and self.low.imag <= at.imag <= self.high.imag
        near = min(abs(place - self.place(way)) for way in CORNERS)
        return BoxGrip("turn") if near <= TURN_REACH * em and not is_inside else None

    def scale_towards(
        self, grip: BoxGrip, start: complex, place: complex, *, keeps_proportions: bool
    ) -> complex:
        """Return the scale of a drag from one place to another: along the axis, and across it."""
        before, after = (self.axis.conjugate() * (at - self.pivot) for at in (start, place))
        if keeps_proportions and grip.way.real and grip.way.imag:
            # The length of the pointer's projection to the line from the pivot to the press.
            share = (after * before.conjugate()).real / (abs(before) ** 2 or 1.0)
            return max(share, SMALLEST) * (1 + 1j)
        x = after.real / before.real if grip.way.real and before.real else 1.0
        y = after.imag / before.imag if grip.way.imag and before.imag else 1.0
        if keeps_proportions:
            x = y = x if grip.way.real else y
        return complex(max(x, SMALLEST), max(y, SMALLEST))

    def idle_shapes(self, em: float, hot: BoxGrip | None) -> Iterator[OverlayShape]:
        """Yield the box with its grips; the grip under the pointer stands out."""
        yield LineShape(
            points=[self.place(way) for way in CORNERS],
            role="text",
            opacity=0.7,
            closed=True,
            width=0.08,
        )
        edge, knob = self.place(self.knob[0]), self.knob_place(em)
        role = _role(hot, BoxGrip("turn"))
        yield LineShape(points=[edge, knob], role="text", opacity=0.7, width=0.08)
        yield KnobShape(centre=knob, radius=KNOB * em, role=role)
        for way, at in self.scale_grips(em):
            corners = [at + self.axis * SQUARE * em * corner for corner in CORNERS]
            role = _role(hot, BoxGrip("scale", way))
            yield LineShape(points=corners, role=role, closed=True, width=0.1)
            yield AreaShape(points=corners, role=role)
        yield from _pivot_shapes(self.pivot, self.axis, em, _role(hot, BoxGrip("pivot")))

    def change(self, scale: complex, turn: float) -> BoxChange:
        """Return the change around the pivot."""
        return BoxChange(pivot=self.pivot, axis=self.axis, scale=scale, turn=turn)

    def drag_shapes(self, scale: complex, turn: float, em: float) -> Iterator[OverlayShape]:
        """Yield the outline and the pivot of the box during a drag."""
        change = self.change(scale, turn)
        corners = [change.apply(self.place(way)) for way in CORNERS]
        yield LineShape(points=corners, role="accent", closed=True, width=0.1)
        yield from _pivot_shapes(self.pivot, self.axis * cmath.exp(1j * turn), em, "accent")


def _pivot_shapes(
    pivot: complex, axis: complex, em: float, role: ColourRole
) -> Iterator[OverlayShape]:
    """Yield the ring and the cross of a pivot."""
    yield CircleShape(centre=pivot, radius=PIVOT * em, role=role, opacity=0.9)
    for way in (axis, 1j * axis):
        arm = TICK * em * way
        yield LineShape(points=[pivot - arm, pivot + arm], role=role, width=0.1)


def _role(hot: BoxGrip | None, grip: BoxGrip) -> ColourRole:
    return "accent" if hot == grip else "text"
