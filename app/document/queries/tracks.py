"""Where tracks want their handles, and about which ones springs swing."""

from bisect import bisect_right
from typing import NamedTuple

import numpy as np

from app.document.layer import Layer
from app.document.queries.clips import Clip
from app.document.queries.memo import memoized_on
from app.document.queries.tangents import (
    KeyedProperty,
    KeySequence,
    TangentSegment,
    Value,
    sample_segment,
    segment_slopes,
)
from app.document.timing import LINEAR, Cycle, Spring, Track, TrackKey
from engine.domain import MeshedDomain
from engine.domain.meshing import find_distances

# By how much two keys may differ that want the same: pixels, and radians.
SAME_PLACE, SAME_TURN = 0.01, 1e-4


class TrackSample(NamedTuple):
    """What a track wants at a frame, as its keys have it."""

    place: complex  # beside the pose in its turning frame, or in the picture; pixels
    turn: float  # beyond the base motion, in radians; 0 where the track does not turn


def track_at(track: Track, clip: Clip, frame: float) -> TrackSample | None:
    """Return what a track wants of its handles at a frame; None where it does not act.

    It acts from its first key to its last one, both included, later by its delay. In a loop frames
    come round, and the last frame is the first one again; so they do in a cycle that takes the
    track, and nowhere else is it then. What a key wants is given to the bit.

    Between two keys place and turn have the passings of keys as whole poses have them
    (`app.document.queries.tangents.sample_segment`), each by itself. Through its first key and its
    last one it comes from rest and to rest, as nothing is moved beyond them; where it fills a loop
    and its ends agree it goes on from the one to the other.
    """
    time = _time(track, clip, frame)
    if time is None or not track.enabled:
        return None
    return TrackSample(
        _value(track, clip, time, PLACE),
        _value(track, clip, time, TURN) if track.keys_rotation else 0.0,
    )


def velocity_at(track: Track, clip: Clip, frame: float) -> complex | None:
    """Return at which velocity a key inserted into a track at a frame changes nothing there.

    In pixels a frame; None where the keys around leave velocities to their passings, where time is
    eased, and where the track does not act.
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
        _key_sequence(track, clip, PLACE), _tangent_segment(keys, index), PLACE
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
    """Return the frame among the track's keys that a frame of the scene shows, if there is one."""
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
    """Return the cycle with which a track repeats, if there is one."""
    return next((cycle for cycle in clip.layer.cycles if cycle.repeats_keys(track.keys)), None)


def _segment_index(track: Track, time: float) -> int:
    """Return the index of the key at a frame or before it."""
    return bisect_right(track.keys, time, key=lambda key: key.frame) - 1


def _key_sequence(
    track: Track, clip: Clip, moved: KeyedProperty[TrackKey, Value]
) -> KeySequence[TrackKey]:
    keys = track.keys
    cycle = track_cycle(track, clip)
    period = cycle.period if cycle else clip.period if clip.loop else 0
    is_whole = 0 < keys[-1].frame - keys[0].frame == period
    gap = 0 if is_whole and moved.is_same(keys[0], keys[-1]) else None
    return KeySequence(keys=keys, gap=gap, is_same=moved.is_same, starts_and_ends_at_rest=True)


def _tangent_segment(keys: tuple[TrackKey, ...], index: int) -> TangentSegment:
    return TangentSegment(index, index + 1, keys[index + 1].frame - keys[index].frame)


def _value(track: Track, clip: Clip, time: float, moved: KeyedProperty[TrackKey, Value]) -> Value:
    """Return what moves at a frame from the first key to the last one."""
    keys, index = track.keys, _segment_index(track, time)
    if time == keys[index].frame:
        return moved.value_of(keys[index])
    leg = _tangent_segment(keys, index)
    share = (time - keys[index].frame) / leg.frames
    return sample_segment(_key_sequence(track, clip, moved), leg, share, moved)


def spring_root(layer: Layer, spring: Spring) -> int | None:
    """Return the id of the handle about which a spring swings; None where there is none.

    It is the spring's own. If that follows by a spring, it is the root of that one, and so on.
    Without one of its own it is the nearest handle that follows by none, first along bones, and
    then along the drawing, never across a gap. What follows is told without tracks, so that these
    change no root.
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
    """Return how far it is along the drawing from the first of some places to the others."""
    return tuple(find_distances(domain.mesh, places[0], np.array(places[1:])).tolist())
