"""Curves: the numbers of a channel over time, in the units that a person reads."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import degrees, nan
from types import MappingProxyType
from typing import Any, Final, NamedTuple

import numpy as np

from app.document.channels.key import BaseKey, Key, KeyedProperty
from app.document.channels.kind import Channel, Quantity, ValueField
from app.document.channels.kinds import POSE, SLIDER, TRACK
from app.document.model import Document
from app.document.queries.channel_values.channel_keys import keys_in, track_in
from app.document.queries.channel_values.tracks_at import PLACE, TURN, track_at, track_sequence
from app.document.queries.channel_values.values_at import channel_sequence, value_at
from app.document.queries.clips import Clip, clip_of
from app.document.queries.key_segments import clip_segments, segment_layout
from app.document.queries.memo import memoized_on
from app.document.queries.tangents import KeySequence
from app.texts import N_, _
from engine.arrays import Floats


class NumberForm(NamedTuple):
    """How a person reads the numbers of a quantity."""

    unit: str = ""
    scale: float = 1.0  # units per stored 1
    # Marked names of its numbers, if there are several. A single number has the field's name.
    parts: tuple[str, ...] = ("",)


# Quantities that are numbers.
FORMS: Final[Mapping[Quantity, NumberForm]] = MappingProxyType(
    {
        Quantity.NUMBER: NumberForm(),
        Quantity.FACTOR: NumberForm("%", 100.0),
        Quantity.SHARE: NumberForm("%", 100.0),
        Quantity.DEPTH: NumberForm(),
        Quantity.POINT: NumberForm("px", parts=(N_("X"), N_("Y"))),
        Quantity.ANGLE: NumberForm("°", degrees(1.0)),
        Quantity.FLAG: NumberForm(),
        Quantity.COLOUR: NumberForm("%", 100.0, (N_("Red"), N_("Green"), N_("Blue"))),
        Quantity.VALUE: NumberForm(parts=(N_("Value"), N_("Second value"))),
    }
)
# The curve of poses, which are no numbers: they are counted from 1.
POSE_NUMBER: Final = ValueField("number", Quantity.NUMBER, label=N_("Pose number"))


@dataclass(frozen=True, slots=True)
class ChannelCurve:
    """A number of a channel over time."""

    channel: Channel[Any]
    field: ValueField
    part: int = 0  # of a field of several numbers

    @property
    def _form(self) -> NumberForm:
        return FORMS[self.field.quantity]

    @property
    def label(self) -> str:
        """The name of the number within its channel; empty if it has none."""
        text = self._form.parts[self.part] or self.field.label
        return _(text) if text else ""

    @property
    def unit(self) -> str:
        return self._form.unit

    @property
    def is_timing(self) -> bool:
        """Whether only the time of the numbers can change, as that of poses."""
        return self.field is POSE_NUMBER

    @property
    def component(self) -> int:
        """The index of the interpolated component that the number belongs to."""
        is_split = self.field.quantity is Quantity.COLOUR
        if is_split or self.is_timing:
            return self.part
        return self.channel.kind.fields.index(self.field)

    def number_of(self, value: Any) -> float:
        """Return the number in a value of the channel, or in a key or a sample of a track."""
        if self.is_timing:
            return float(value)
        return self._form.scale * _numbers(self._field_of(value))[self.part]

    def number_at_key(self, document: Document, key: BaseKey) -> float:
        """Return the number at a key of the channel."""
        if self.is_timing:
            return 1.0 + keys_in(document, self.channel).index(key)
        return self.number_of(key.value if isinstance(key, Key) else key)

    def with_number(self, key: BaseKey, number: float, pace: float = 1.0) -> BaseKey:
        """Return a key with another number, or with the nearest one that is allowed.

        The number's own velocity, if the key has one, is multiplied by `pace`.
        """
        if self.is_timing:
            return key
        component = component_of(self)
        velocity = None if component is None or pace == 1.0 else component.velocity(key)
        if velocity is not None:
            old = self.number_of(key.value if isinstance(key, Key) else key)
            pace *= self.stored_per_number(number) / self.stored_per_number(old)
            velocity = self.with_part(velocity, pace * self.part_of(velocity))
            key = self.with_velocity(key, velocity)
        low, high = self.field.limits
        value: Any = key.value if isinstance(key, Key) else key
        numbers = _numbers(self._field_of(value))
        numbers[self.part] = min(max(number / self._form.scale, low), high)
        own = _joined(self.field.quantity, numbers)
        if not isinstance(key, Key):
            return replace(key, **{self.field.name: own})
        is_whole = len(self.channel.kind.fields) == 1
        return replace(key, value=own if is_whole else replace(value, **{self.field.name: own}))

    def with_velocity(self, key: BaseKey, velocity: complex) -> BaseKey:
        """Return a key with a velocity of its own in the curve's interpolated component."""
        if not isinstance(key, Key):
            return replace(key, velocity=complex(velocity))  # type: ignore[call-arg]
        velocities = [*(key.velocities or (None,) * len(self.channel.kind.components))]
        velocities[self.component] = velocity
        return replace(key, velocities=tuple(velocities))

    def _field_of(self, value: Any) -> Any:
        kind, name = self.channel.kind, self.field.name
        return getattr(value, name) if kind is TRACK else kind.field_of(value, name)

    def stored_per_number(self, number: float) -> float:
        """Return how fast the interpolated component changes with the number, at a number.

        Factors are interpolated by their logarithms.
        """
        if self.field.quantity is Quantity.FACTOR:
            return 1.0 / max(number, 1e-9)
        return 1.0 / self._form.scale

    def part_of(self, component: complex) -> float:
        """Return this number's part of an interpolated component, or of its velocity."""
        return _numbers(component)[self.part if isinstance(component, complex) else 0]

    def with_part(self, component: complex, stored: float) -> complex | float:
        """Return an interpolated component, or its velocity, with another part for this number."""
        if self.field.quantity not in (Quantity.POINT, Quantity.VALUE):
            return stored
        numbers = _numbers(complex(component))
        numbers[self.part] = stored
        return complex(*numbers)


def _numbers(stored: Any) -> list[float]:
    """Return the numbers of a field of a value."""
    if isinstance(stored, tuple):
        return [*stored]
    return [stored.real, stored.imag] if isinstance(stored, complex) else [float(stored)]


def _joined(quantity: Quantity, numbers: list[float]) -> Any:
    """Return a field of a value, made of its numbers."""
    match quantity:
        case Quantity.POINT | Quantity.VALUE:
            return complex(*numbers)
        case Quantity.COLOUR:
            return tuple(numbers)
        case Quantity.FLAG:
            return numbers[0] >= 0.5
    return numbers[0]


def curves_of(document: Document, channel: Channel[Any]) -> tuple[ChannelCurve, ...]:
    """Return the curves of a channel; none if its keys have no numbers."""
    if channel.kind is POSE:
        return (ChannelCurve(channel, POSE_NUMBER),)
    track, layer = track_in(document, channel), document.find_layer(channel.layer or 0)
    fields = [each for each in channel.kind.fields if each.quantity in FORMS]
    if track is not None and not track.keys_rotation:
        fields = fields[:1]
    curves = [
        ChannelCurve(channel, field, part)
        for field in fields
        for part in range(len(FORMS[field.quantity].parts))
    ]
    if channel.kind is SLIDER and layer is not None and not layer.slider(str(channel.part)).is_pad:
        curves = curves[:1]
    return tuple(each for each in curves if each.label)


@memoized_on
def sample_curves(
    document: Document, channel: Channel[Any], frames: tuple[float, ...]
) -> Mapping[ChannelCurve, Floats]:
    """Return the numbers of a channel's curves at some frames, as `numbers_at`."""
    return numbers_at(document, channel, frames)


def numbers_at(
    document: Document, channel: Channel[Any], frames: Iterable[float]
) -> Mapping[ChannelCurve, Floats]:
    """Return the numbers of a channel's curves at some frames; NaN where it has no effect."""
    value_of = _evaluator(document, channel)
    values = [value_of(frame) for frame in frames]
    return {
        curve: np.array([nan if each is None else curve.number_of(each) for each in values])
        for curve in curves_of(document, channel)
    }


def _evaluator(document: Document, channel: Channel[Any]) -> Callable[[float], Any]:
    """Return the function that gives the value of a channel at a frame; None has no effect."""
    if channel.kind is POSE:
        return partial(_pose_number_at, clip_of(document, channel.layer or 0))
    track = track_in(document, channel)
    if track is not None and channel.layer is not None:
        return partial(track_at, replace(track, enabled=True), clip_of(document, channel.layer))
    return partial(value_at, document, channel)


def _pose_number_at(clip: Clip, frame: float) -> float:
    """Return the number of the pose at a frame, with the share to the next pose."""
    keys, layout = clip.keys, segment_layout(clip)
    frame = clip.frames.wrap(frame) if clip.loop else frame
    for ring in layout.cycles:
        if ring.covers(frame):
            frame = ring.cycle.source_frame(frame)
    for segment in clip_segments(clip):
        start = segment.start
        if segment == layout.loop_segment and frame < start:
            start -= clip.period
        if segment.first != segment.last and start <= frame < start + segment.frames:
            share = keys[segment.first].easing((frame - start) / segment.frames)
            return segment.first + 1 + share
    return 1.0 + sum(key.frame <= frame for key in keys[1:])


def component_of(curve: ChannelCurve) -> KeyedProperty[Any, Any] | None:
    """Return the interpolated component of a curve; None for poses and for keys that hold."""
    if curve.channel.kind is TRACK:
        return PLACE if curve.component == 0 else TURN
    components = curve.channel.kind.components
    return components[curve.component] if components else None


def curve_sequence(document: Document, curve: ChannelCurve) -> KeySequence[Any]:
    """Return the key sequence by which the curve's component is interpolated."""
    channel, component = curve.channel, component_of(curve)
    keys: tuple[Any, ...] = keys_in(document, channel)
    track = track_in(document, channel)
    if component is None:
        gap = None
        if channel.kind is POSE:
            closing = segment_layout(clip_of(document, channel.layer or 0)).loop_segment
            gap = None if closing is None else closing.frames
        return KeySequence(keys=keys, gap=gap, is_same=lambda one, other: one is other)
    if track is not None and channel.layer is not None:
        return track_sequence(track, clip_of(document, channel.layer), component)
    cycles = () if channel.layer is None else document.layer(channel.layer).cycles
    return channel_sequence(document, channel.kind, keys, component, cycles)
