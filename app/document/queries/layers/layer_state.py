"""Camera, transform, opacity and draw order at a frame."""

from bisect import bisect_right
from collections.abc import Sequence
from math import exp, log
from typing import NamedTuple, TypeVar

import numpy as np

from app.document.layer import Layer
from app.document.layers.layer_keys import CameraKey, DrawOrderKey, OpacityKey, TransformKey
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
from app.document.timing.cycles import Cycle
from engine.arrays import Complexes
from engine.geometry import IDENTITY_MOTION, RigidMotion, Similarity

Key = TypeVar("Key", CameraKey, TransformKey, OpacityKey)

# Keys closer than this count as equal: pixels, radians, logarithms of zoom, and opacity.
SAME_PLACE, SAME_TURN, SAME_ZOOM, SAME_OPACITY = 0.01, 1e-4, 1e-5, 1e-4
CENTRE = KeyedProperty[CameraKey, complex](lambda key: key.centre, SAME_PLACE)
ZOOM = KeyedProperty[CameraKey, float](lambda key: log(key.zoom), SAME_ZOOM)
CAMERA_TURN = KeyedProperty[CameraKey, float](lambda key: key.turn, SAME_TURN)
SHIFT = KeyedProperty[TransformKey, complex](lambda key: key.shift, SAME_PLACE)
TURN = KeyedProperty[TransformKey, float](lambda key: key.turn, SAME_TURN)
DEFAULT_DRAW_ORDER = (DrawOrderKey(0, None),)
OPACITY = KeyedProperty[OpacityKey, float](lambda key: key.opacity, SAME_OPACITY)


class CameraState(NamedTuple):
    centre: complex  # point of the scene in the centre of the frame
    zoom: float  # above 0
    turn: float  # rotation of the picture, counter-clockwise, in radians

    def canvas_motion(self, canvas: tuple[int, int]) -> Similarity:
        """Return the similarity that maps the visible part of the scene to the canvas."""
        factor = self.zoom * complex(np.exp(1j * self.turn))
        return Similarity(factor, complex(*canvas) / 2 - factor * self.centre)

    def frame_corners(self, canvas: tuple[int, int]) -> Complexes:
        """Return the corners (4,) of the visible part, counter-clockwise from the lower left."""
        seen, (width, height) = self.canvas_motion(canvas), canvas
        corners = (0j, complex(width, 0), complex(width, height), complex(0, height))
        return np.array([seen.apply_inverse(corner) for corner in corners])


def camera_at(document: Document, frame: float) -> CameraState | None:
    """Return the camera at a frame; None without camera keys.

    The camera holds before its first key and after its last. In a loop, a segment leads from the
    last key to the first.
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
    """Return the rigid motion of a whole layer at a frame."""
    keys, cycle = layer.transform_keys, repeating_cycle(layer, layer.transform_keys)
    if not keys:
        return IDENTITY_MOTION
    shift = _value_at(document, keys, SHIFT, frame, cycle)
    turn = _value_at(document, keys, TURN, frame, cycle)
    factor = complex(np.exp(1j * turn))
    return RigidMotion(factor, layer.pivot + shift - factor * layer.pivot)


def opacity_at(document: Document, layer: Layer, frame: float) -> float:
    """Return the opacity of a layer at a frame, 0 to 1."""
    keys = layer.opacity_keys
    if not keys:
        return layer.opacity
    found = _value_at(document, keys, OPACITY, frame, repeating_cycle(layer, keys))
    return min(max(found, 0.0), 1.0)


def repeating_cycle(
    layer: Layer, keys: Sequence[TransformKey] | Sequence[OpacityKey]
) -> Cycle | None:
    """Return the cycle with which transform or opacity keys repeat, if any.

    The cycle contains all keys. A key at its end equals the key at its beginning except for full
    turns.
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
    """Return the frame whose key affects this frame; in repeats, an earlier frame."""
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
    """Return the draw order key in effect at a frame; None before the first."""
    order_keys = repeated(
        layer.draw_order_keys, layer.cycles, document.frames.last, DEFAULT_DRAW_ORDER
    )
    count = bisect_right(order_keys, frame, key=lambda each: each.frame)
    return order_keys[count - 1] if count else None


def layers_in_draw_order(document: Document, frame: float) -> tuple[Layer, ...]:
    """Return the layers at a frame from back to front.

    Layers with a draw order key move next to their reference layer, each after the reference layer
    has moved. In a circle, the layer with the oldest key moves first. Clipped layers move with
    their base unless they have keys of their own, and no layer goes between them.
    """
    placed: dict[int, tuple[int, int, bool]] = {}
    for layer in document.layers:
        order_key = draw_order_key_at(document, layer, frame)
        if order_key is not None and order_key.beside is not None:
            placed[layer.id] = order_key.frame, order_key.beside, order_key.in_front
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
            # A clipped layer moves with its base.
            continue
        order = [each for each in order if each not in along]
        # Clipping to a layer inside a group stays inside the group.
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
    """Return the interpolated value at a frame, constant outside the keys."""
    frame, period = document.loop_frame(frame), document.frames.last - document.frames.first
    if cycle is not None:
        frame, period = cycle.clamped_source_frame(frame, document.frames.last), cycle.period
    first, last = keys[0].frame, keys[-1].frame
    sequence = _key_sequence(keys, moved, period if document.loop or cycle is not None else 0)
    if first <= frame < last:
        index = bisect_right(keys, frame, key=lambda key: key.frame) - 1
        leg = TangentSegment(index, index + 1, keys[index + 1].frame - keys[index].frame)
    elif sequence.gap:
        leg = TangentSegment(len(keys) - 1, 0, sequence.gap)
        frame += 0 if frame >= last else period
    else:
        return moved.value_of(keys[0] if frame < first else keys[-1])
    return sample_segment(sequence, leg, (frame - keys[leg.first].frame) / leg.frames, moved)


def _key_sequence(
    keys: tuple[Key, ...], moved: KeyedProperty[Key, Value], period: int
) -> KeySequence[Key]:
    """Return the key sequence; with a period, the last key leads to the first."""
    gap = None
    if period:
        gap = period - (keys[-1].frame - keys[0].frame)
        if not gap and not moved.is_same(keys[0], keys[-1]):
            gap = None
    return KeySequence(keys=keys, gap=gap, is_same=moved.is_same, starts_and_ends_at_rest=True)
