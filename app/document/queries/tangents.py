"""Tangents at keys, from tangent modes and easings.

Between two keys, a value is a cubic Hermite polynomial of the eased time.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import Generic, NamedTuple, TypeVar

from app.document.channels.easing import HOLD
from app.document.channels.key import BaseKey, KeyedProperty, Value
from app.document.channels.tangent_mode import TangentMode
from engine.interpolation import InteriorKnot

# Tangent of a segment at a key: the knot of a smooth key, or the share of a straight blend's speed,
# 1 at a corner and 0 at a stop.
KeyTangent = InteriorKnot | float


Keyed = TypeVar("Keyed", bound=BaseKey)


class TangentSegment(NamedTuple):
    """From one key to another: key indices and length in frames."""

    first: int
    last: int
    frames: int


@dataclass(frozen=True, slots=True, kw_only=True)
class KeySequence(Generic[Keyed]):
    """Keys in order of time, and the motion beyond their ends."""

    keys: tuple[Keyed, ...]
    # Length in frames from the last key to the first. 0 if the two are the same moment, None if the
    # motion does not wrap around.
    gap: int | None
    is_same: Callable[[Keyed, Keyed], bool]  # whether two keys have the same value
    # Whether smooth first and last keys have zero velocity; otherwise the motion is straight there.
    starts_and_ends_at_rest: bool = False

    def tangents(self, index: int) -> tuple[KeyTangent, KeyTangent]:
        """Return the tangents before and after a key."""
        before, after = self.segment_before(index), self.segment_after(index)
        is_end = self.starts_and_ends_at_rest and None in (before, after)
        return tangents_at(self.keys, index, before, after, self.is_same, is_end=is_end)

    def segment_before(self, index: int) -> TangentSegment | None:
        """Return the segment that ends at a key."""
        last = len(self.keys) - 1
        if index > 0:
            return TangentSegment(
                index - 1, index, self.keys[index].frame - self.keys[index - 1].frame
            )
        if self.gap is None:
            return None
        return TangentSegment(last, 0, self.gap) if self.gap else self.segment_before(last)

    def segment_after(self, index: int) -> TangentSegment | None:
        """Return the segment that begins at a key."""
        last = len(self.keys) - 1
        if index < last:
            return TangentSegment(
                index, index + 1, self.keys[index + 1].frame - self.keys[index].frame
            )
        if self.gap is None:
            return None
        return TangentSegment(last, 0, self.gap) if self.gap else self.segment_after(0)


def tangents_at(
    keys: Sequence[Keyed],
    index: int,
    before: TangentSegment | None,
    after: TangentSegment | None,
    is_same: Callable[[Keyed, Keyed], bool],
    *,
    is_end: bool = False,
) -> tuple[KeyTangent, KeyTangent]:
    """Return the tangents of the segments before and after a key.

    `is_same` returns whether two keys have the same value. With `is_end`, a smooth key has zero
    velocity, as at the first and the last key.
    """
    before, after = _moving_segment(keys, before), _moving_segment(keys, after)
    reached = keys[index if before is None else before.last]
    left = keys[index if after is None else after.first]
    end_pace = 1.0 if before is None else keys[before.first].easing.end_speeds[1]
    start_pace = 1.0 if after is None else left.easing.end_speeds[0]
    stops = stop_factor(end_pace), stop_factor(start_pace)
    if before and after and reached.tangent_mode is left.tangent_mode is TangentMode.SMOOTH:
        if is_same(left, keys[before.first]) or is_same(left, keys[after.last]):
            # Equal neighbours mean that the value is kept; a smooth tangent would overshoot.
            return stops
        joint = InteriorKnot(before.frames, after.frames)
        if end_pace == start_pace == 0.0:
            return joint, joint
        if 0.0 in (end_pace, start_pace):
            return stops
        if isfinite(end_pace) and isfinite(start_pace):
            joint = replace(joint, end_pace=end_pace, start_pace=start_pace)
            return joint, joint
        return 1.0, 1.0
    resting = {TangentMode.STOP, TangentMode.SMOOTH} if is_end else {TangentMode.STOP}
    return (
        stops[0] if reached.tangent_mode in resting else 1.0,
        stops[1] if left.tangent_mode in resting else 1.0,
    )


def _moving_segment(keys: Sequence[BaseKey], leg: TangentSegment | None) -> TangentSegment | None:
    """Return the segment unless it is a hold."""
    return None if leg is None or keys[leg.first].easing == HOLD else leg


def stop_factor(pace: float) -> float:
    """Return 0 if the blend must stop at a key, 1 if its easing already stops there."""
    return 1.0 if pace == 0.0 else 0.0


def sample_segment(
    sequence: KeySequence[Keyed],
    leg: TangentSegment,
    time: float,
    moved: KeyedProperty[Keyed, Value],
) -> Value:
    """Return the value at a share of a segment, 0 to 1; exact at both keys.

    A smooth key has its own velocity, or the slope of the parabola through it and its neighbours.
    Next to an equal neighbour it is a stop.
    """
    one, other = sequence.keys[leg.first], sequence.keys[leg.last]
    share = one.easing(time)
    if share in (0.0, 1.0):
        return moved.value_of(other if share else one)
    change, rest = moved.value_of(other) - moved.value_of(one), 1.0 - share
    leaving, reaching = segment_slopes(sequence, leg, moved)
    return moved.value_of(one) + share * (
        share * (3.0 - 2.0 * share) * change + rest * (rest * leaving - share * reaching)
    )


def segment_slopes(
    sequence: KeySequence[Keyed], leg: TangentSegment, moved: KeyedProperty[Keyed, Value]
) -> tuple[Value, Value]:
    """Return the slopes over the eased time at both ends of a segment."""
    change = moved.value_of(sequence.keys[leg.last]) - moved.value_of(sequence.keys[leg.first])
    return (
        _slope(sequence, leg.first, moved, change, side=1),
        _slope(sequence, leg.last, moved, change, side=0),
    )


def _slope(
    sequence: KeySequence[Keyed],
    index: int,
    moved: KeyedProperty[Keyed, Value],
    change: Value,
    *,
    side: int,
) -> Value:
    """Return the slope over the eased time before a key or, for side 1, after it.

    `change` is the difference of the segment's two keys.
    """
    keys = sequence.keys
    before, after = sequence.segment_before(index), sequence.segment_after(index)
    velocity, arms = _own_velocity(sequence, index, moved)
    if velocity is not None:
        return arms[side] * velocity
    end = sequence.tangents(index)[side]
    if not isinstance(end, InteriorKnot):
        return end * change
    window = (before.first if before else index, index, after.last if after else index)
    first, middle, last = (
        share * moved.value_of(keys[i])
        for share, i in zip(end.velocity.tolist(), window, strict=True)
    )
    slope: Value = 3.0 * abs(end.control_offsets[side]) * (first + middle + last)
    return slope


def _own_velocity(
    sequence: KeySequence[Keyed], index: int, moved: KeyedProperty[Keyed, Value]
) -> tuple[Value | None, tuple[float, float]]:
    """Return a key's own velocity, and the lengths in frames of a linear blend at its speeds.

    The lengths are of the segments before and after the key. The velocity is None unless the key is
    smooth and both easings have finite positive speeds there.
    """
    keys = sequence.keys
    before, after = sequence.segment_before(index), sequence.segment_after(index)
    reached, left = keys[before.last if before else index], keys[after.first if after else index]
    end_pace = keys[before.first].easing.end_speeds[1] if before else 1.0
    start_pace = left.easing.end_speeds[0] if after else 1.0
    velocity = moved.velocity(left)
    is_led = (
        velocity == moved.velocity(reached)
        and reached.tangent_mode is left.tangent_mode is TangentMode.SMOOTH
        and all(0.0 < pace < inf for pace in (end_pace, start_pace))
    )
    if not is_led:
        return None, (0.0, 0.0)
    arms = (before.frames if before else 0) / end_pace, (after.frames if after else 0) / start_pace
    return velocity, arms
