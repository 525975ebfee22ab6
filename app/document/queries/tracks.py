"""Where tracks want their handles."""

from bisect import bisect_right
from collections.abc import Callable
from math import inf
from typing import Generic, NamedTuple, TypeVar

from app.document.queries.clips import Clip
from app.document.queries.passages import Passages
from app.document.timing import LINEAR, Cycle, Passing, Track, TrackKey
from engine.interpolation import Joint

# By how much two keys may differ that want the same: pixels, and radians.
SAME_PLACE, SAME_TURN = 0.01, 1e-4

Value = TypeVar("Value", float, complex)


class TrackPlace(NamedTuple):
    """What a track wants at a frame, as its keys have it."""

    place: complex  # beside the pose in its turning frame, or in the picture; pixels
    turn: float  # beyond the base motion, in radians; 0 where the track does not turn


def track_at(track: Track, clip: Clip, frame: float) -> TrackPlace | None:
    """Return what a track wants of its handles at a frame; None where it does not act.

    It acts from its first key to its last one, both included, later by its delay. In a loop frames
    come round, and the last frame is the first one again; so they do in a cycle that takes the
    track, and nowhere else is it then. What a key wants is given to the bit.

    Between two keys place and turn are cubic Hermite polynomials of the eased time, with the
    passings of keys as whole poses have them (`app.document.queries.passages`): through a key at
    its own velocity, or with the slope of the parabola through it and its neighbours, and each with
    a stop where a neighbour wants the same of it. Through its first key and its last one it comes
    from rest and to rest, as nothing is moved beyond them; where it fills a loop and its ends agree
    it goes on from the one to the other.
    """
    time = _time(track, clip, frame)
    if time is None or not track.enabled:
        return None
    return TrackPlace(
        _value(track, clip, time, PLACE), _value(track, clip, time, TURN) if track.turns else 0.0
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
    index = _interval(track, time)
    one, other = keys[index : index + 2]
    if one.easing != LINEAR or one.velocity is other.velocity is None:
        return None
    length = other.frame - one.frame
    share = (time - one.frame) / length
    change, (leaving, reaching) = other.place - one.place, _slopes(track, clip, index, PLACE)
    rest = 1.0 - share
    slope = 6.0 * share * rest * change
    slope += rest * (1.0 - 3.0 * share) * leaving - share * (2.0 - 3.0 * share) * reaching
    return slope / length


class _Moved(NamedTuple, Generic[Value]):
    """What moves between keys."""

    of: Callable[[TrackKey], Value]
    velocity: Callable[[TrackKey], Value | None]
    same: float  # by how much two keys may differ that want the same


PLACE = _Moved[complex](lambda key: key.place, lambda key: key.velocity, SAME_PLACE)
TURN = _Moved[float](lambda key: key.turn, lambda _: None, SAME_TURN)


def _time(track: Track, clip: Clip, frame: float) -> float | None:
    """Return the frame among the track's keys that a frame of the scene shows, if there is one."""
    first, last = track.keys[0].frame, track.keys[-1].frame
    cycle, period = _cycle(track, clip), clip.period if clip.loop else 0
    if period and frame not in clip.frames:
        frame = clip.frames.first + (frame - clip.frames.first) % period
    time = frame - track.delay
    if cycle is not None:
        if not cycle.covers(frame):
            return None
        time, period = cycle.source(time), cycle.period
    for at in (time, time + period, time - period):
        if first <= at <= last:
            return at
    return None


def _cycle(track: Track, clip: Clip) -> Cycle | None:
    """Return the cycle with which a track repeats, if there is one."""
    return next((cycle for cycle in clip.figure.cycles if cycle.takes(track)), None)


def _interval(track: Track, time: float) -> int:
    """Return the index of the key at a frame or before it."""
    return bisect_right(track.keys, time, key=lambda key: key.frame) - 1


def _value(track: Track, clip: Clip, time: float, moved: _Moved[Value]) -> Value:
    """Return what moves at a frame from the first key to the last one."""
    of, keys, index = moved.of, track.keys, _interval(track, time)
    if time == keys[index].frame:
        return of(keys[index])
    one, other = keys[index], keys[index + 1]
    share = one.easing((time - one.frame) / (other.frame - one.frame))
    if share in (0.0, 1.0):
        return of(other if share else one)
    change, rest = of(other) - of(one), 1.0 - share
    leaving, reaching = _slopes(track, clip, index, moved)
    return of(one) + share * (
        share * (3.0 - 2.0 * share) * change + rest * (rest * leaving - share * reaching)
    )


def _slopes(track: Track, clip: Clip, index: int, moved: _Moved[Value]) -> tuple[Value, Value]:
    """Return the slopes, over the eased time, with which a key is left and the next one reached."""
    keys = track.keys

    def is_same(key: TrackKey, other: TrackKey) -> bool:
        return abs(moved.of(key) - moved.of(other)) <= moved.same

    cycle = _cycle(track, clip)
    period = cycle.period if cycle else clip.period if clip.loop else 0
    is_whole = 0 < keys[-1].frame - keys[0].frame == period
    gap = 0 if is_whole and is_same(keys[0], keys[-1]) else None
    passages = Passages(keys=keys, gap=gap, is_same=is_same, ends_rest=True)
    change = moved.of(keys[index + 1]) - moved.of(keys[index])
    return (
        _slope(passages, index, moved, change, side=1),
        _slope(passages, index + 1, moved, change, side=0),
    )


def _slope(
    passages: Passages[TrackKey], index: int, moved: _Moved[Value], change: Value, *, side: int
) -> Value:
    """Return the slope, over the eased time, with which a key is reached or, on side 1, left.

    The change is that from the interval's first key to its second one.
    """
    keys = passages.keys
    before, after = passages.arriving(index), passages.leaving(index)
    velocity, arms = _led(passages, index, moved)
    if velocity is not None:
        return arms[side] * velocity
    end = passages.ends(index)[side]
    if not isinstance(end, Joint):
        return end * change
    window = (before.first if before else index, index, after.last if after else index)
    first, middle, last = (
        share * moved.of(keys[i]) for share, i in zip(end.velocity.tolist(), window, strict=True)
    )
    slope: Value = 3.0 * abs(end.arms[side]) * (first + middle + last)
    return slope


def _led(
    passages: Passages[TrackKey], index: int, moved: _Moved[Value]
) -> tuple[Value | None, tuple[float, float]]:
    """Return a key's own velocity, and the frames that an even blend takes at the paces there.

    They are those of the leg that leads to it, and of the one that leads on. There is no velocity
    where the key is not passed through, nor where an easing stands still there, or jumps.
    """
    keys = passages.keys
    before, after = passages.arriving(index), passages.leaving(index)
    reached, left = keys[before.last if before else index], keys[after.first if after else index]
    end_pace = keys[before.first].easing.paces[1] if before else 1.0
    start_pace = left.easing.paces[0] if after else 1.0
    velocity = moved.velocity(left)
    is_led = (
        velocity == moved.velocity(reached)
        and reached.passing is left.passing is Passing.THROUGH
        and all(0.0 < pace < inf for pace in (end_pace, start_pace))
    )
    if not is_led:
        return None, (0.0, 0.0)
    arms = (before.frames if before else 0) / end_pace, (after.frames if after else 0) / start_pace
    return velocity, arms
