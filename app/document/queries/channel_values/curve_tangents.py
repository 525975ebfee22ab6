"""Tangents of curves at keys: where their handles are in a graph, and how they become keys.

The handle of a segment is the control point of its Bézier curve, where the segment is one: with
straight ends, or with an even easing. Elsewhere it lies on the tangent of the motion.
"""

from dataclasses import replace
from math import inf
from typing import Any, Literal, NamedTuple

from app.document.channels.easing import Easing
from app.document.channels.key import BaseKey, Key
from app.document.channels.kinds import POSE
from app.document.channels.tangent_mode import TangentMode
from app.document.channels.tracks import TrackKey
from app.document.model import Document
from app.document.queries.channel_values.curves import ChannelCurve, component_of, curve_sequence
from app.document.queries.tangents import KeySequence, TangentSegment, segment_slopes

# Side of a key: the segment before it, or the segment after it.
Side = Literal[0, 1]
EVEN = 1 / 3  # both coordinates of the control points of an even easing
SHORTEST = 0.1  # share of its segment that the handle of a retracted control point has
LEAST = 0.02  # share of its segment up to which a handle gives a velocity
LARGEST_VELOCITY = 1e6


class TangentHandle(NamedTuple):
    """A handle of a key in a graph, relative to the key."""

    frames: float  # before or after the key, not negative
    change: float  # of the curve's number


def find_tangent_handle(
    document: Document, curve: ChannelCurve, index: int, side: Side
) -> TangentHandle | None:
    """Return a handle of the key at an index; None for a segment that is missing or holds."""
    sequence = curve_sequence(document, curve)
    segment = _segment(sequence, index, side)
    control = None if segment is None else _control(sequence.keys[segment.first].easing, side)
    if segment is None or control is None or curve.channel.kind.is_held:
        return None
    share, weight = control
    slope = _number_slope(document, curve, sequence, segment, side)
    return TangentHandle(share * segment.frames, (1 if side else -1) * weight * slope)


def with_tangent_handle(
    document: Document, curve: ChannelCurve, index: int, side: Side, handle: TangentHandle
) -> dict[int, BaseKey]:
    """Return the keys, by their frames, that put the handle of a key as near to a place as can be.

    A smooth key, or one that stops, gets a velocity of its own along the handle, if its kind has
    velocities. Otherwise the easing of the segment takes the handle as its control point.
    """
    sequence = curve_sequence(document, curve)
    segment = _segment(sequence, index, side)
    if segment is None or sequence.keys[segment.first].easing.curve is None:
        return {}
    if _takes_velocity(curve, sequence, index):
        frames = max(handle.frames, LEAST * segment.frames)
        velocity = (1 if side else -1) * handle.change / frames
        return with_velocity(document, curve, index, velocity)
    key = sequence.keys[segment.first]
    share, weight = _control(key.easing, side) or (EVEN, EVEN)
    share = min(max(handle.frames / segment.frames, 0.0), 1.0)
    slope = (1 if side else -1) * _number_slope(document, curve, sequence, segment, side)
    if abs(slope) > 1e-9:
        weight = min(max(handle.change / slope, 0.0), 1.0)
    return {key.frame: replace(key, easing=_with_control(key.easing, side, share, weight))}


def with_velocity(
    document: Document, curve: ChannelCurve, index: int, velocity: float
) -> dict[int, BaseKey]:
    """Return the keys, by their frames, that give a key a velocity of its own, per frame.

    Easings that stop at the key become even there. The ends of a closed motion change together.
    """
    sequence, component = curve_sequence(document, curve), component_of(curve)
    keys, last = sequence.keys, len(sequence.keys) - 1
    if component is None or not _takes_velocity(curve, sequence, index):
        return {}
    number = curve.number_at_key(document, keys[index])
    stored = velocity * curve.stored_per_number(number)
    stored = min(max(stored, -LARGEST_VELOCITY), LARGEST_VELOCITY)
    present = component.velocity(keys[index])
    if present is None:
        present = _present_velocity(curve, sequence, index)
    whole = curve.with_part(present, stored)
    changed: dict[int, BaseKey] = {}
    for place in {index, *({0, last} if sequence.gap == 0 and index in (0, last) else ())}:
        smooth = replace(keys[place], tangent_mode=TangentMode.SMOOTH)
        changed[place] = curve.with_velocity(smooth, whole)
    for side in (0, 1):
        segment = _segment(sequence, index, side)
        if segment is None:
            continue
        key = changed.get(segment.first, keys[segment.first])
        pace = key.easing.end_speeds[1 - side]
        if not 0.0 < pace < inf:
            key = replace(key, easing=_with_control(key.easing, side, EVEN, EVEN))
            changed[segment.first] = key
    return {key.frame: key for key in changed.values()}


def find_velocity(document: Document, curve: ChannelCurve, index: int) -> float:
    """Return the velocity of a curve's number after a key, or before the last; 0 in a hold."""
    after = find_tangent_handle(document, curve, index, 1)
    if after is not None:
        return after.change / max(after.frames, 1e-9)
    before = find_tangent_handle(document, curve, index, 0)
    return 0.0 if before is None else -before.change / max(before.frames, 1e-9)


def _takes_velocity(curve: ChannelCurve, sequence: KeySequence[Any], index: int) -> bool:
    """Return whether a key can have a velocity of its own: it does not turn sharply, or hold."""
    key, component = sequence.keys[index], component_of(curve)
    has_field = isinstance(key, Key) or (isinstance(key, TrackKey) and curve.component == 0)
    segments = (_segment(sequence, index, side) for side in (0, 1))
    holds = any(each and sequence.keys[each.first].easing.curve is None for each in segments)
    is_soft = key.tangent_mode in (TangentMode.SMOOTH, TangentMode.STOP)
    return component is not None and has_field and is_soft and not holds


def _present_velocity(
    curve: ChannelCurve, sequence: KeySequence[Any], index: int
) -> complex | float:
    """Return the velocity of a component at a key, where it is finite; 0 elsewhere."""
    component = component_of(curve)
    for side in (1, 0):
        segment = _segment(sequence, index, side)
        if segment is None or component is None:
            continue
        pace = sequence.keys[segment.first].easing.end_speeds[1 - side]
        if pace < inf:
            slope = segment_slopes(sequence, segment, component)[1 - side]
            velocity: complex | float = slope * pace / segment.frames
            return velocity
    return 0.0


def _segment(sequence: KeySequence[Any], index: int, side: int) -> TangentSegment | None:
    return sequence.segment_after(index) if side else sequence.segment_before(index)


def _number_slope(
    document: Document,
    curve: ChannelCurve,
    sequence: KeySequence[Any],
    segment: TangentSegment,
    side: Side,
) -> float:
    """Return the slope of the curve's number over the eased time at an end of a segment."""
    component = component_of(curve)
    if component is None:
        return 1.0 if curve.channel.kind is POSE else 0.0
    slope = curve.part_of(segment_slopes(sequence, segment, component)[1 - side])
    key = sequence.keys[segment.first if side else segment.last]
    return slope / curve.stored_per_number(curve.number_at_key(document, key))


def _control(easing: Easing, side: int) -> tuple[float, float] | None:
    """Return a control point of an easing, from the key on; None for a hold.

    An even easing has its control points at thirds. A retracted one lies a little way along the
    tangent, so that it can be seen.
    """
    if easing.curve is None:
        return None
    x1, y1, x2, y2 = easing.curve
    if (x1, x2) == (y1, y2):
        return EVEN, EVEN
    share, weight = (x1, y1) if side else (1.0 - x2, 1.0 - y2)
    if share < SHORTEST > weight:
        pace = easing.end_speeds[1 - side]
        return (SHORTEST, SHORTEST * pace) if pace <= 1.0 else (SHORTEST / pace, SHORTEST)
    return share, weight


def _with_control(easing: Easing, side: int, share: float, weight: float) -> Easing:
    """Return an easing with another control point, given from the key on."""
    x1, y1, x2, y2 = easing.curve or (0.0, 0.0, 1.0, 1.0)
    if (x1, x2) == (y1, y2):
        x1 = y1 = EVEN
        x2 = y2 = 1.0 - EVEN
    share, weight = round(share, 4), round(weight, 4)
    return Easing((share, weight, x2, y2) if side else (x1, y1, 1.0 - share, 1.0 - weight))
