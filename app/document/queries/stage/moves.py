"""What the camera shows at a frame, and where, how opaque and in which order figures are."""

from bisect import bisect_right
from math import exp, log
from typing import NamedTuple, TypeVar

import numpy as np

from app.document.figure import Figure
from app.document.layering import CameraKey, MoveKey, OpacityKey
from app.document.model import Document
from app.document.queries.passages import Leg, Moved, Passages, Value, value_on
from engine.arrays import Complexes
from engine.geometry import HERE, RigidMotion, Similarity

Key = TypeVar("Key", CameraKey, MoveKey, OpacityKey)

# By how much two keys may differ that want the same: pixels, radians, logarithms, and opacity.
SAME_PLACE, SAME_TURN, SAME_ZOOM, SAME_OPACITY = 0.01, 1e-4, 1e-5, 1e-4
CENTRE = Moved[CameraKey, complex](lambda key: key.centre, SAME_PLACE)
ZOOM = Moved[CameraKey, float](lambda key: log(key.zoom), SAME_ZOOM)
CAMERA_TURN = Moved[CameraKey, float](lambda key: key.turn, SAME_TURN)
SHIFT = Moved[MoveKey, complex](lambda key: key.shift, SAME_PLACE)
TURN = Moved[MoveKey, float](lambda key: key.turn, SAME_TURN)
OPACITY = Moved[OpacityKey, float](lambda key: key.opacity, SAME_OPACITY)


class Shot(NamedTuple):
    """What the camera shows."""

    centre: complex  # the point of the plane in the middle of the frame
    zoom: float  # above 0
    turn: float  # by how much things are seen turned, counter-clockwise, in radians

    def on_canvas(self, canvas: tuple[int, int]) -> Similarity:
        """Return which motion of all things makes the canvas show what the camera does."""
        factor = self.zoom * complex(np.exp(1j * self.turn))
        return Similarity(factor, complex(*canvas) / 2 - factor * self.centre)

    def frame(self, canvas: tuple[int, int]) -> Complexes:
        """Return the corners of what is seen (4,), counter-clockwise from the lower left one."""
        seen, (width, height) = self.on_canvas(canvas), canvas
        corners = (0j, complex(width, 0), complex(width, height), complex(0, height))
        return np.array([seen.back(corner) for corner in corners])


def camera_at(document: Document, frame: float) -> Shot | None:
    """Return what the camera shows at a frame; None where there is none.

    It is held before its first key and after its last one; in a loop the last one leads on to the
    first one.
    """
    keys = document.camera
    if not keys:
        return None
    return Shot(
        _value_at(document, keys, CENTRE, frame),
        exp(_value_at(document, keys, ZOOM, frame)),
        _value_at(document, keys, CAMERA_TURN, frame),
    )


def movement_at(document: Document, figure: Figure, frame: float) -> RigidMotion:
    """Return by which a figure is moved as a whole at a frame, as the camera is."""
    keys = figure.movement
    if not keys:
        return HERE
    shift, turn = (_value_at(document, keys, SHIFT, frame), _value_at(document, keys, TURN, frame))
    factor = complex(np.exp(1j * turn))
    return RigidMotion(factor, figure.pivot + shift - factor * figure.pivot)


def opacity_at(document: Document, figure: Figure, frame: float) -> float:
    """Return how opaque a figure is at a frame, 0 to 1."""
    keys = figure.opacities
    if not keys:
        return figure.opacity
    return min(max(_value_at(document, keys, OPACITY, frame), 0.0), 1.0)


def in_order(document: Document, frame: float) -> tuple[Figure, ...]:
    """Return the figures from the one behind all others at a frame to the one in front.

    Those that are placed beside another one then come there one after the other, each after that
    other one; in a circle, the one whose place is oldest comes first.
    """
    placed: dict[int, tuple[int, int, bool]] = {}
    for figure in document.figures:
        placing = next((each for each in reversed(figure.placings) if each.frame <= frame), None)
        if placing is not None and placing.beside is not None:
            placed[figure.id] = placing.frame, placing.beside, placing.in_front
    order = [figure.id for figure in document.figures]
    while placed:
        oldest = sorted(placed, key=lambda identity: placed[identity][0])
        moved = next((each for each in oldest if placed[each][1] not in placed), oldest[0])
        _, beside, in_front = placed.pop(moved)
        order.remove(moved)
        order.insert(order.index(beside) + in_front, moved)
    return tuple(map(document.figure, order))


def _value_at(
    document: Document, keys: tuple[Key, ...], moved: Moved[Key, Value], frame: float
) -> Value:
    """Return what moves between keys at a frame; from rest and to rest where it is held."""
    frame = document.in_time(frame)
    first, last = keys[0].frame, keys[-1].frame
    passages = _round(document, keys, moved)
    if first <= frame < last:
        index = bisect_right(keys, frame, key=lambda key: key.frame) - 1
        leg = Leg(index, index + 1, keys[index + 1].frame - keys[index].frame)
    elif passages.gap:
        leg = Leg(len(keys) - 1, 0, passages.gap)
        frame += 0 if frame >= last else document.frames.last - document.frames.first
    else:
        return moved.of(keys[0] if frame < first else keys[-1])
    return value_on(passages, leg, (frame - keys[leg.first].frame) / leg.frames, moved)


def _round(document: Document, keys: tuple[Key, ...], moved: Moved[Key, Value]) -> Passages[Key]:
    """Return how keys are passed; in a loop the last one leads on to the first one."""
    gap = None
    if document.loop:
        gap = document.frames.last - document.frames.first - (keys[-1].frame - keys[0].frame)
        if not gap and not moved.is_same(keys[0], keys[-1]):
            gap = None
    return Passages(keys=keys, gap=gap, is_same=moved.is_same, ends_rest=True)
