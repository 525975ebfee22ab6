"""What the camera shows at a frame, and where, how opaque and in which order layers are."""

from bisect import bisect_right
from collections.abc import Sequence
from math import exp, log
from typing import NamedTuple, TypeVar

import numpy as np

from app.document.layer import Layer
from app.document.layers import CameraKey, DrawOrderKey, OpacityKey, TransformKey
from app.document.model import Document
from app.document.queries.layers.clipping import clip_stacks
from app.document.queries.layers.visibility import repeated
from app.document.queries.tangents import (
    KeyedProperty,
    KeySequence,
    TangentSegment,
    Value,
    sample_segment,
)
from app.document.timing import Cycle
from engine.arrays import Complexes
from engine.geometry import IDENTITY_MOTION, RigidMotion, Similarity

Key = TypeVar("Key", CameraKey, TransformKey, OpacityKey)

# By how much two keys may differ that want the same: pixels, radians, logarithms, and opacity.
SAME_PLACE, SAME_TURN, SAME_ZOOM, SAME_OPACITY = 0.01, 1e-4, 1e-5, 1e-4
CENTRE = KeyedProperty[CameraKey, complex](lambda key: key.centre, SAME_PLACE)
ZOOM = KeyedProperty[CameraKey, float](lambda key: log(key.zoom), SAME_ZOOM)
CAMERA_TURN = KeyedProperty[CameraKey, float](lambda key: key.turn, SAME_TURN)
SHIFT = KeyedProperty[TransformKey, complex](lambda key: key.shift, SAME_PLACE)
TURN = KeyedProperty[TransformKey, float](lambda key: key.turn, SAME_TURN)
DEFAULT_DRAW_ORDER = (DrawOrderKey(0, None),)
OPACITY = KeyedProperty[OpacityKey, float](lambda key: key.opacity, SAME_OPACITY)


class CameraState(NamedTuple):
    """What the camera shows."""

    centre: complex  # the point of the plane in the middle of the frame
    zoom: float  # above 0
    turn: float  # by how much things are seen turned, counter-clockwise, in radians

    def canvas_motion(self, canvas: tuple[int, int]) -> Similarity:
        """Return which motion of all things makes the canvas show what the camera does."""
        factor = self.zoom * complex(np.exp(1j * self.turn))
        return Similarity(factor, complex(*canvas) / 2 - factor * self.centre)

    def frame_corners(self, canvas: tuple[int, int]) -> Complexes:
        """Return the corners of what is seen (4,), counter-clockwise from the lower left one."""
        seen, (width, height) = self.canvas_motion(canvas), canvas
        corners = (0j, complex(width, 0), complex(width, height), complex(0, height))
        return np.array([seen.apply_inverse(corner) for corner in corners])


def camera_at(document: Document, frame: float) -> CameraState | None:
    """Return what the camera shows at a frame; None where there is none.

    It is held before its first key and after its last one; in a loop the last one leads on to the
    first one.
    """
    keys = document.camera
    if not keys:
        return None
    return CameraState(
        _value_at(document, keys, CENTRE, frame),
        exp(_value_at(document, keys, ZOOM, frame)),
        _value_at(document, keys, CAMERA_TURN, frame),
    )


def transform_at(document: Document, layer: Layer, frame: float) -> RigidMotion:
    """Return by which a layer is moved as a whole at a frame, as the camera is."""
    keys, cycle = layer.transform_keys, repeating_cycle(layer, layer.transform_keys)
    if not keys:
        return IDENTITY_MOTION
    shift = _value_at(document, keys, SHIFT, frame, cycle)
    turn = _value_at(document, keys, TURN, frame, cycle)
    factor = complex(np.exp(1j * turn))
    return RigidMotion(factor, layer.pivot + shift - factor * layer.pivot)


def opacity_at(document: Document, layer: Layer, frame: float) -> float:
    """Return how opaque a layer is at a frame, 0 to 1."""
    keys = layer.opacity_keys
    if not keys:
        return layer.opacity
    found = _value_at(document, keys, OPACITY, frame, repeating_cycle(layer, keys))
    return min(max(found, 0.0), 1.0)


def repeating_cycle(
    layer: Layer, keys: Sequence[TransformKey] | Sequence[OpacityKey]
) -> Cycle | None:
    """Return the cycle of a layer with which its movement or its opacity repeats, if one does.

    That has all of their keys, and where one is at its end it is as that at its beginning, but for
    whole turns. What goes on elsewhere has its own time.
    """
    if len(keys) < 2:
        return None
    first, last = keys[0], keys[-1]
    for cycle in layer.cycles:
        if cycle.repeats_keys(keys) and (
            last.frame - first.frame < cycle.period or _alike(first, last)
        ):
            return cycle
    return None


def keyed_frame(
    layer: Layer, keys: Sequence[TransformKey] | Sequence[OpacityKey], frame: int
) -> int:
    """Return the frame at which a layer's movement or opacity at a frame is keyed.

    It is another one where they repeat.
    """
    cycle = repeating_cycle(layer, keys)
    return int(cycle.source_frame(frame)) if cycle is not None and cycle.covers(frame) else frame


def _alike(first: TransformKey | OpacityKey, last: TransformKey | OpacityKey) -> bool:
    if isinstance(first, TransformKey) and isinstance(last, TransformKey):
        turned = abs(np.exp(1j * first.turn) - np.exp(1j * last.turn)) <= SAME_TURN
        return bool(turned) and SHIFT.is_same(first, last)
    if isinstance(first, OpacityKey) and isinstance(last, OpacityKey):
        return OPACITY.is_same(first, last)
    return False


def draw_order_key_at(document: Document, layer: Layer, frame: float) -> DrawOrderKey | None:
    """Return beside what a layer is painted at a frame; None before that is said."""
    placings = repeated(
        layer.draw_order_keys, layer.cycles, document.frames.last, DEFAULT_DRAW_ORDER
    )
    count = bisect_right(placings, frame, key=lambda each: each.frame)
    return placings[count - 1] if count else None


def layers_in_draw_order(document: Document, frame: float) -> tuple[Layer, ...]:
    """Return the layers from the one behind all others at a frame to the one in front.

    Those that are placed beside another one then come there one after the other, each after that
    other one; in a circle, the one whose place is oldest comes first. What is clipped goes with
    what clips it, unless it is placed itself, and nothing comes between these.
    """
    placed: dict[int, tuple[int, int, bool]] = {}
    for layer in document.layers:
        placing = draw_order_key_at(document, layer, frame)
        if placing is not None and placing.beside is not None:
            placed[layer.id] = placing.frame, placing.beside, placing.in_front
    if not placed:
        return document.layers
    order = [layer.id for layer in document.layers]
    own, clipping = frozenset(placed), clip_stacks(document)
    while placed:
        oldest = sorted(placed, key=lambda identity: placed[identity][0])
        moved = next((each for each in oldest if placed[each][1] not in placed), oldest[0])
        _, beside, in_front = placed.pop(moved)
        cut = [each for stack in clipping if stack.base == (moved,) for each in stack.clipped]
        along = [moved, *(each for each in cut if each not in own)]
        if beside in along:
            # It is there already: what it clips goes with it.
            continue
        order = [each for each in order if each not in along]
        # What is clipped by a group's layer is so inside of the group.
        around = {beside}
        for stack in clipping:
            whole = {*stack.base, *stack.clipped}
            if moved not in whole and (stack.base == (beside,) or beside in stack.clipped):
                around |= whole - own
        places = [order.index(each) for each in around]
        at = max(places) + 1 if in_front else min(places)
        order[at:at] = along
    return tuple(map(document.layer, order))


def _value_at(
    document: Document,
    keys: tuple[Key, ...],
    moved: KeyedProperty[Key, Value],
    frame: float,
    cycle: Cycle | None = None,
) -> Value:
    """Return what moves between keys at a frame; from rest and to rest where it is held."""
    frame, period = document.loop_frame(frame), document.frames.last - document.frames.first
    if cycle is not None:
        frame, period = cycle.clamped_source_frame(frame, document.frames.last), cycle.period
    first, last = keys[0].frame, keys[-1].frame
    passages = _key_sequence(keys, moved, period if document.loop or cycle is not None else 0)
    if first <= frame < last:
        index = bisect_right(keys, frame, key=lambda key: key.frame) - 1
        leg = TangentSegment(index, index + 1, keys[index + 1].frame - keys[index].frame)
    elif passages.gap:
        leg = TangentSegment(len(keys) - 1, 0, passages.gap)
        frame += 0 if frame >= last else period
    else:
        return moved.value_of(keys[0] if frame < first else keys[-1])
    return sample_segment(passages, leg, (frame - keys[leg.first].frame) / leg.frames, moved)


def _key_sequence(
    keys: tuple[Key, ...], moved: KeyedProperty[Key, Value], period: int
) -> KeySequence[Key]:
    """Return how keys are passed; where they come round the last one leads on to the first one."""
    gap = None
    if period:
        gap = period - (keys[-1].frame - keys[0].frame)
        if not gap and not moved.is_same(keys[0], keys[-1]):
            gap = None
    return KeySequence(keys=keys, gap=gap, is_same=moved.is_same, starts_and_ends_at_rest=True)
