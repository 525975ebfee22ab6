"""Rectangles of the screen, and a free place for a card."""

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from imgui_bundle import ImVec2

from engine.arrays import Booleans, Complexes

COVERS = 1e5  # cost of covering the whole drawing, in pixels of distance
LITTLE = 0.01  # share of the drawing that may be covered before another room is tried
STEPS = 9  # tried places along each side of the room


class Rect(NamedTuple):
    low: ImVec2
    high: ImVec2

    @property
    def middle(self) -> ImVec2:
        return (self.low + self.high) / 2

    def grown(self, by: float) -> "Rect":
        """Return a rectangle that is larger on each side by so many pixels."""
        return Rect(self.low - ImVec2(by, by), self.high + ImVec2(by, by))

    def meets(self, other: "Rect") -> bool:
        return (
            self.low.x < other.high.x
            and other.low.x < self.high.x
            and self.low.y < other.high.y
            and other.low.y < self.high.y
        )

    def holds(self, points: Complexes) -> Booleans:
        """Return which of the points are inside."""
        inside = (points.real > self.low.x) & (points.real < self.high.x)
        return inside & (points.imag > self.low.y) & (points.imag < self.high.y)

    def nearest(self, point: ImVec2) -> ImVec2:
        x = min(max(point.x, self.low.x), self.high.x)
        return ImVec2(x, min(max(point.y, self.low.y), self.high.y))


def find_free_corner(
    size: ImVec2, boxes: Sequence[Rect], rooms: Sequence[Rect], drawing: Complexes, gap: float
) -> ImVec2:
    """Return a near corner at which a card covers no box and, if possible, nothing of the drawing.

    Parameters
    ----------
    boxes : sequence of Rect
        Must not be covered; the card is near the first one.
    rooms : sequence of Rect
        Allowed areas for the card, in order of preference.
    drawing : complex128, shape (n,)
        Points of the drawing. The card covers as few as possible.
    gap : float
        Pixels between the card and its boxes.
    """
    found = [_best_corner(size, boxes, room, drawing, gap) for room in rooms]
    return min(found, key=lambda each: (each.covers > 1.0, each.covers > LITTLE)).corner


class _Corner(NamedTuple):
    """A corner for a card, and the covered share of the drawing; 2 if the card covers a box."""

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
