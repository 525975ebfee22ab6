"""Rectangles of the screen, and a place for a card among them."""

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from imgui_bundle import ImVec2

from engine.arrays import Booleans, Complexes

COVERS = 1e5  # pixels of distance that it is worth not to cover the whole drawing
LITTLE = 0.01  # of the drawing, that may be covered before another room is taken
STEPS = 9  # places that are tried along each side of the room


class Rect(NamedTuple):
    """A rectangle of the screen."""

    low: ImVec2
    high: ImVec2

    @property
    def middle(self) -> ImVec2:
        """Its centre."""
        return (self.low + self.high) / 2

    def grown(self, by: float) -> "Rect":
        """Return one that is larger on each side by so many pixels."""
        return Rect(self.low - ImVec2(by, by), self.high + ImVec2(by, by))

    def meets(self, other: "Rect") -> bool:
        """Tell whether they overlap."""
        return (
            self.low.x < other.high.x
            and other.low.x < self.high.x
            and self.low.y < other.high.y
            and other.low.y < self.high.y
        )

    def holds(self, points: Complexes) -> Booleans:
        """Return which points are in it."""
        inside = (points.real > self.low.x) & (points.real < self.high.x)
        return inside & (points.imag > self.low.y) & (points.imag < self.high.y)

    def nearest(self, point: ImVec2) -> ImVec2:
        """Return its point that is nearest to another one."""
        x = min(max(point.x, self.low.x), self.high.x)
        return ImVec2(x, min(max(point.y, self.low.y), self.high.y))


def find_free_corner(
    size: ImVec2, boxes: Sequence[Rect], rooms: Sequence[Rect], drawing: Complexes, gap: float
) -> ImVec2:
    """Return where a card of a size covers no box, nothing of a drawing, and is near.

    Parameters
    ----------
    size : ImVec2
    boxes : sequence of Rect
        What is not covered; the card is near the first one.
    rooms : sequence of Rect
        Where the card may be: in the first of them in which that can be.
    drawing : complex128, shape (n,)
        Points of it. If there is no other way, the card covers as few as can be.
    gap : float
        Pixels between the card and what it points at.
    """
    found = [_best_corner(size, boxes, room, drawing, gap) for room in rooms]
    return min(found, key=lambda each: (each.covers > 1.0, each.covers > LITTLE)).corner


class _Corner(NamedTuple):
    """A place for a card, and the share of the drawing that it covers; 2 if it covers a box."""

    corner: ImVec2
    covers: float


def _best_corner(
    size: ImVec2, boxes: Sequence[Rect], room: Rect, drawing: Complexes, gap: float
) -> _Corner:
    ends = room.high - size
    xs = list(np.linspace(room.low.x, max(ends.x, room.low.x), STEPS))
    ys = list(np.linspace(room.low.y, max(ends.y, room.low.y), STEPS))
    for box in boxes:
        xs += [box.low.x - size.x - gap, box.middle.x - size.x / 2, box.high.x + gap]
        ys += [box.low.y - size.y - gap, box.middle.y - size.y / 2, box.high.y + gap]
    target = boxes[0].middle if boxes else ImVec2(ends.x, room.low.y)
    best, least = _Corner(ImVec2(xs[STEPS - 1], ys[0]), 2.0), np.inf
    for x, y in product(xs, ys):
        corner = ImVec2(max(min(x, ends.x), room.low.x), max(min(y, ends.y), room.low.y))
        card = Rect(corner, corner + size)
        if any(card.meets(box.grown(gap / 2)) for box in boxes):
            continue
        covers = float(card.holds(drawing).mean())
        way = target - card.nearest(target)
        cost = COVERS * covers + float(np.hypot(way.x, way.y))
        if cost < least:
            best, least = _Corner(corner, covers), cost
    return best
