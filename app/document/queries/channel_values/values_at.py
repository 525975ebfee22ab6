"""Camera, transform, opacity and draw order at a frame."""

from bisect import bisect_right
from typing import Any, Protocol, TypeVar, cast

from app.document.channels.cycles import Cycle
from app.document.channels.key import Key, KeyedProperty
from app.document.channels.kind import Channel, ChannelKind
from app.document.channels.kinds import (
    CAMERA,
    DRAW_ORDER,
    FOOTAGE_TIME,
    OPACITY,
    SLIDER,
    SWITCH,
    TRANSFORM,
    VISIBILITY,
    VOLUME,
)
from app.document.channels.sounds import Sound
from app.document.channels.values import Camera, DrawOrder
from app.document.layer import Layer
from app.document.model import Document
from app.document.queries.channel_values.footage_at import footage_time_at
from app.document.queries.channel_values.repeats import (
    held_key_at,
    repeated_keys,
    repeating_cycle,
    rest_value,
    with_repeats,
)
from app.document.queries.layers.clipping import clip_stacks
from app.document.queries.layers.visibility import is_visible
from app.document.queries.tangents import KeySequence, TangentSegment, sample_segment
from app.document.settings import FrameRange
from engine.geometry import IDENTITY_MOTION, Similarity

V = TypeVar("V")


class Timeline(Protocol):
    """What the time between keys depends on: a document, or a clip of it."""

    @property
    def frames(self) -> FrameRange: ...

    @property
    def loop(self) -> bool: ...


def camera_at(document: Document, frame: float) -> Camera | None:
    """Return the camera at a frame; None without camera keys.

    The camera holds before its first key and after its last. In a loop, a segment leads from the
    last key to the first.
    """
    return interpolated_value(document, CAMERA, document.camera, frame)


def layer_value_at(
    document: Document,
    layer: Layer,
    kind: ChannelKind[V],
    frame: float,
    part: int | str | None = None,
) -> V | None:
    """Return the value of an interpolated channel of a layer at a frame; None without keys."""
    return interpolated_value(document, kind, layer.keys_of(kind, part), frame, layer.cycles)


def transform_at(document: Document, layer: Layer, frame: float) -> Similarity:
    """Return the motion of a layer without a parent at a frame: its transform about its pivot."""
    transform = layer_value_at(document, layer, TRANSFORM, frame)
    return IDENTITY_MOTION if transform is None else transform.about(layer.pivot)


def opacity_at(document: Document, layer: Layer, frame: float) -> float:
    """Return the opacity of a layer at a frame, 0 to 1."""
    opacity = layer_value_at(document, layer, OPACITY, frame)
    return layer.opacity if opacity is None else opacity


def volume_at(document: Document, sound: Sound, frame: float) -> float:
    """Return the volume of a sound at a frame, 0 to 1."""
    volume = interpolated_value(document, VOLUME, sound.keys, frame)
    return sound.volume if volume is None else volume


def draw_order_key_at(document: Document, layer: Layer, frame: float) -> Key[DrawOrder] | None:
    """Return the draw order key in effect at a frame; None before the first."""
    keys = layer.keys_of(DRAW_ORDER)
    return held_key_at(
        repeated_keys(keys, layer.cycles, document.frames.last, DrawOrder(None)), frame
    )


def layers_in_draw_order(document: Document, frame: float) -> tuple[Layer, ...]:
    """Return the layers at a frame from back to front.

    Layers with a draw order key move next to their reference layer, each after the reference layer
    has moved. In a circle, the layer with the oldest key moves first. Clipped layers move with
    their base unless they have keys of their own, and no layer goes between them.
    """
    placed: dict[int, tuple[int, int, bool]] = {}
    for layer in document.layers:
        key = draw_order_key_at(document, layer, frame)
        if key is not None and key.value.beside is not None:
            placed[layer.id] = key.frame, key.value.beside, key.value.in_front
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


def value_at(document: Document, channel: Channel[V], frame: float) -> V:
    """Return the value of a channel at a frame, also without keys."""
    kind: ChannelKind[Any] = channel.kind
    found: Any
    if kind is CAMERA:
        found = camera_at(document, frame) or Camera(complex(*document.canvas) / 2)
    elif kind is SWITCH:
        found = with_repeats(document, document.switch_group(str(channel.part))).member_at(frame)
    elif kind is VOLUME:
        found = volume_at(document, document.sound(str(channel.part)), frame)
    else:
        layer = document.layer(channel.layer or 0)
        if not kind.is_held:
            value = layer_value_at(document, layer, kind, frame, channel.part)
            found = unkeyed_value(layer, channel) if value is None else value
        elif kind is VISIBILITY:
            found = is_visible(document, layer, frame)
        elif kind is FOOTAGE_TIME:
            found = footage_time_at(document, layer, frame)
        else:
            keys, rest = layer.keys_of(kind, channel.part), rest_value(layer, kind, channel.part)
            repeats = repeated_keys(keys, layer.cycles, document.frames.last, rest)
            key = held_key_at(repeats, frame)
            found = rest if key is None else key.value
    return cast(V, found)


def unkeyed_value(layer: Layer, channel: Channel[Any]) -> Any:
    """Return the value of an interpolated channel of a layer without keys."""
    if channel.kind is SLIDER:
        return layer.slider(str(channel.part)).value
    return layer.opacity if channel.kind is OPACITY else channel.kind.default


def interpolated_value(
    timeline: Timeline,
    kind: ChannelKind[V],
    keys: tuple[Key[V], ...],
    frame: float,
    cycles: tuple[Cycle, ...] = (),
) -> V | None:
    """Return the interpolated value at a frame, constant outside the keys; None without keys."""
    if not keys:
        return None
    cycle, frames = repeating_cycle(kind, keys, cycles), timeline.frames
    frame = frames.wrap(frame) if timeline.loop else frame
    if cycle is not None:
        frame = cycle.clamped_source_frame(frame, frames.last)
    period = _repeat_period(timeline, cycle)
    return kind.join(*(_component_at(keys, each, frame, period) for each in kind.components))


def channel_sequence(
    timeline: Timeline,
    kind: ChannelKind[V],
    keys: tuple[Key[V], ...],
    component: KeyedProperty[Key[V], Any],
    cycles: tuple[Cycle, ...] = (),
) -> KeySequence[Key[V]]:
    """Return the key sequence by which `interpolated_value` interpolates a component."""
    cycle = repeating_cycle(kind, keys, cycles)
    return _key_sequence(keys, component, _repeat_period(timeline, cycle))


def _repeat_period(timeline: Timeline, cycle: Cycle | None) -> int:
    """Return the frames after which keys repeat, in a cycle or in a loop; 0 if they do not."""
    if cycle is not None:
        return cycle.period
    return timeline.frames.last - timeline.frames.first if timeline.loop else 0


def _component_at(
    keys: tuple[Key[Any], ...], component: KeyedProperty[Key[Any], Any], frame: float, period: int
) -> Any:
    """Return one number at a frame; with a period, the last key leads to the first."""
    first, last = keys[0].frame, keys[-1].frame
    sequence = _key_sequence(keys, component, period)
    if first <= frame < last:
        index = bisect_right(keys, frame, key=lambda key: key.frame) - 1
        segment = TangentSegment(index, index + 1, keys[index + 1].frame - keys[index].frame)
    elif sequence.gap:
        segment = TangentSegment(len(keys) - 1, 0, sequence.gap)
        frame += 0 if frame >= last else period
    else:
        return component.value_of(keys[0] if frame < first else keys[-1])
    share = (frame - keys[segment.first].frame) / segment.frames
    return sample_segment(sequence, segment, share, component)


def _key_sequence(
    keys: tuple[Key[Any], ...], component: KeyedProperty[Key[Any], Any], period: int
) -> KeySequence[Key[Any]]:
    """Return the key sequence; with a period, the last key leads to the first."""
    gap = None
    if period:
        gap = period - (keys[-1].frame - keys[0].frame)
        if not gap and not component.is_same(keys[0], keys[-1]):
            gap = None
    return KeySequence(keys=keys, gap=gap, is_same=component.is_same, starts_and_ends_at_rest=True)
