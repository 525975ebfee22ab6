"""Where tracks want their handles."""

from bisect import bisect_right
from collections.abc import Callable
from typing import NamedTuple, TypeVar

from app.document.queries.clips import Clip
from app.document.queries.passages import Passages
from app.document.timing import Track, TrackKey
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
    come round, and the last frame is the first one again. What a key wants is given to the bit.

    Between two keys place and turn are cubic Hermite polynomials of the eased time, with the
    passings of keys as whole poses have them (`app.document.queries.passages`): through a key with
    the slope of the parabola through it and its neighbours, and each with a stop where a neighbour
    wants the same of it.
    """
    time = _time(track, clip, frame)
    if time is None or not track.enabled:
        return None
    place = _value(track, clip, time, lambda key: key.place, SAME_PLACE)
    turn = _value(track, clip, time, lambda key: key.turn, SAME_TURN) if track.turns else 0.0
    return TrackPlace(place, turn)


def _time(track: Track, clip: Clip, frame: float) -> float | None:
    """Return the frame among the track's keys that a frame of the scene shows, if there is one."""
    first, last = track.keys[0].frame, track.keys[-1].frame
    period = clip.period if clip.loop else 0
    if period and frame not in clip.frames:
        frame = clip.frames.first + (frame - clip.frames.first) % period
    time = frame - track.delay
    for at in (time, time + period, time - period):
        if first <= at <= last:
            return at
    return None


def _value(
    track: Track, clip: Clip, time: float, of: Callable[[TrackKey], Value], same: float
) -> Value:
    """Return what is `of` the keys at a frame from the first to the last of them."""
    keys = track.keys
    index = bisect_right(keys, time, key=lambda key: key.frame) - 1
    if time == keys[index].frame:
        return of(keys[index])
    one, other = keys[index], keys[index + 1]
    share = one.easing((time - one.frame) / (other.frame - one.frame))
    if share in (0.0, 1.0):
        return of(other if share else one)

    def is_same(key: TrackKey, other: TrackKey) -> bool:
        return abs(of(key) - of(other)) <= same

    is_whole = clip.loop and 0 < keys[-1].frame - keys[0].frame == clip.period
    gap = 0 if is_whole and is_same(keys[0], keys[-1]) else None
    passages = Passages(keys=keys, gap=gap, is_same=is_same)
    change, rest = of(other) - of(one), 1.0 - share
    leaving = _slope(passages, index, of, change, side=1)
    reaching = _slope(passages, index + 1, of, change, side=0)
    return of(one) + share * (
        share * (3.0 - 2.0 * share) * change + rest * (rest * leaving - share * reaching)
    )


def _slope(
    passages: Passages[TrackKey],
    index: int,
    of: Callable[[TrackKey], Value],
    change: Value,
    *,
    side: int,
) -> Value:
    """Return the slope, over the eased time, with which a key is reached or, on side 1, left.

    The change is that from the interval's first key to its second one.
    """
    end = passages.ends(index)[side]
    if not isinstance(end, Joint):
        return end * change
    before, after = passages.arriving(index), passages.leaving(index)
    window = (before.first if before else index, index, after.last if after else index)
    first, middle, last = (
        share * of(passages.keys[i]) for share, i in zip(end.velocity.tolist(), window, strict=True)
    )
    slope: Value = 3.0 * abs(end.arms[side]) * (first + middle + last)
    return slope
