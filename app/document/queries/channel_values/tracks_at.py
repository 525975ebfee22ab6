"""Positions of tracks at a frame, and roots of springs."""

from bisect import bisect_right
from typing import NamedTuple

import numpy as np

from app.document.channels.cycles import Cycle
from app.document.channels.easing import LINEAR
from app.document.channels.key import KeyedProperty, Value
from app.document.channels.springs import Spring
from app.document.channels.tracks import Track, TrackKey
from app.document.layer import Layer
from app.document.queries.clips import Clip
from app.document.queries.memo import memoized_on
from app.document.queries.tangents import (
    KeySequence,
    TangentSegment,
    sample_segment,
    segment_slopes,
)
from engine.domain import MeshedDomain
from engine.domain.meshing.depth import find_distances

# Keys closer than this count as equal: pixels, and radians.
SAME_PLACE, SAME_TURN = 0.01, 1e-4


class TrackSample(NamedTuple):
    """Value of a track at a frame, in the space of its keys."""

    place: complex  # relative to the pose in its rotating frame, or in the picture; pixels
    turn: float  # relative to the base motion, in radians; 0 if the track keys no rotation


def track_at(track: Track, clip: Clip, frame: float) -> TrackSample | None:
    """Return the value of a track at a frame; None outside the range of its keys.

    The range is delayed by the track's delay. It wraps around in a loop, and repeats in a cycle
    that contains the track. The value at a key is exact.

    Position and rotation are interpolated separately
    (`app.document.queries.tangents.sample_segment`). Smooth first and last keys have zero velocity,
    since the track has no effect beyond them. If the track fills a loop and its ends agree, the
    motion continues from the last to the first.
    """
    time = _time(track, clip, frame)
    if time is None or not track.enabled:
        return None
    return TrackSample(
        _value(track, clip, time, PLACE),
        _value(track, clip, time, TURN) if track.keys_rotation else 0.0,
    )


def velocity_at(track: Track, clip: Clip, frame: float) -> complex | None:
    """Return the velocity at which a key inserted at this frame does not change the motion.

    In pixels per frame. None if the keys around have no velocities, the segment is eased, or the
    frame is outside the track.
    """
    time = _time(track, clip, frame)
    keys = track.keys
    if time is None or time == keys[-1].frame:
        return None
    index = _segment_index(track, time)
    one, other = keys[index : index + 2]
    if one.easing != LINEAR or one.velocity is other.velocity is None:
        return None
    length = other.frame - one.frame
    share = (time - one.frame) / length
    change = other.place - one.place
    leaving, reaching = segment_slopes(
        track_sequence(track, clip, PLACE), _tangent_segment(keys, index), PLACE
    )
    rest = 1.0 - share
    slope = 6.0 * share * rest * change
    slope += rest * (1.0 - 3.0 * share) * leaving - share * (2.0 - 3.0 * share) * reaching
    return slope / length


PLACE = KeyedProperty[TrackKey, complex](
    lambda key: key.place, SAME_PLACE, lambda key: key.velocity
)
TURN = KeyedProperty[TrackKey, float](lambda key: key.turn, SAME_TURN)


def _time(track: Track, clip: Clip, frame: float) -> float | None:
    """Return the frame within the track's keys that a frame of the document shows, if any."""
    first, last = track.keys[0].frame, track.keys[-1].frame
    cycle, period = track_cycle(track, clip), clip.period if clip.loop else 0
    if period and frame not in clip.frames:
        frame = clip.frames.first + (frame - clip.frames.first) % period
    time = frame - track.delay
    if cycle is not None:
        if not cycle.covers(frame):
            return None
        time, period = cycle.source_frame(time), cycle.period
    for at in (time, time + period, time - period):
        if first <= at <= last:
            return at
    return None


def track_cycle(track: Track, clip: Clip) -> Cycle | None:
    """Return the cycle with which a track repeats, if any."""
    return next((cycle for cycle in clip.layer.cycles if cycle.repeats_keys(track.keys)), None)


def _segment_index(track: Track, time: float) -> int:
    """Return the index of the last key at or before a frame."""
    return bisect_right(track.keys, time, key=lambda key: key.frame) - 1


def track_sequence(
    track: Track, clip: Clip, moved: KeyedProperty[TrackKey, Value]
) -> KeySequence[TrackKey]:
    """Return the key sequence by which a track's position or rotation is interpolated."""
    keys = track.keys
    cycle = track_cycle(track, clip)
    period = cycle.period if cycle else clip.period if clip.loop else 0
    is_whole = 0 < keys[-1].frame - keys[0].frame == period
    gap = 0 if is_whole and moved.is_same(keys[0], keys[-1]) else None
    return KeySequence(keys=keys, gap=gap, is_same=moved.is_same, starts_and_ends_at_rest=True)


def _tangent_segment(keys: tuple[TrackKey, ...], index: int) -> TangentSegment:
    return TangentSegment(index, index + 1, keys[index + 1].frame - keys[index].frame)


def _value(track: Track, clip: Clip, time: float, moved: KeyedProperty[TrackKey, Value]) -> Value:
    """Return the interpolated value at a frame within the keys."""
    keys, index = track.keys, _segment_index(track, time)
    if time == keys[index].frame:
        return moved.value_of(keys[index])
    leg = _tangent_segment(keys, index)
    share = (time - keys[index].frame) / leg.frames
    return sample_segment(track_sequence(track, clip, moved), leg, share, moved)


def spring_root(layer: Layer, spring: Spring) -> int | None:
    """Return the id of the handle about which a spring swings, if any.

    The spring's own root comes first; if that has a spring, the root of that spring, and so on. The
    default root is the nearest handle without a spring, first along bones, then along the drawing,
    never across a gap. Tracks have no influence on the root.
    """
    seen = {spring.handle}
    while spring.root is not None:
        following = layer.spring_of(spring.root)
        if following is None or not following.enabled:
            return spring.root
        if spring.root in seen:
            break
        seen.add(spring.root)
        spring = following
    following_ids = {each.handle for each in layer.springs if each.enabled} | seen
    held = [each for each in layer.handles if each.id not in following_ids]
    bones = [bone.ends for bone in layer.bones if spring.handle in bone.ends]
    on_bones = [each for each in held if any(each.id in ends for ends in bones)]
    nearest = on_bones or held
    if not nearest:
        return None
    places = (layer.handle(spring.handle).position, *(each.position for each in nearest))
    return nearest[int(np.argmin(_distances(layer.domain, places)))].id


@memoized_on
def _distances(domain: MeshedDomain, places: tuple[complex, ...]) -> tuple[float, ...]:
    """Return the distances along the drawing from the first point to the others."""
    return tuple(find_distances(domain.mesh, places[0], np.array(places[1:])).tolist())
