"""How the motion of a clip leaves its keys and reaches them, by their passings and easings."""

from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple

import numpy as np

from app.document.keyframe import Keyframe
from app.document.layer import Layer
from app.document.queries.clips import Clip
from app.document.queries.key_segments import ResolvedCycle, Segment, clip_segments, segment_layout
from app.document.queries.memo import memoized_on
from app.document.queries.tangents import KeyTangent, TangentSegment, stop_factor, tangents_at
from app.document.settings import FrameRange
from app.document.timing import TangentMode
from engine.interpolation import InteriorKnot, support_of
from engine.variant import Baseline

# Pixels by which the coefficients of two maps may differ that are the same to the eye: the solver
# comes back to a pose only so closely.
SAME_MAP = 0.01


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PoseSegment:
    """How a clip goes from one key to the next."""

    # The two; with the one before where `start` is a joint, and the one after where `end` is one.
    # Then those that joints apart have in place of one of the two, as `engine.interpolation` orders
    # them.
    keys: tuple[Keyframe, ...]
    revolutions: tuple[int, ...]  # whole turns on the way from each of them to the next
    start: KeyTangent
    end: KeyTangent
    # Whether the joints are of a cycle that this is no part of: the one after the first key, and
    # the one before the second key, are others then.
    apart: tuple[bool, bool] = (False, False)

    @property
    def has_smooth_tangent(self) -> bool:
        """Whether it depends on other keys than the two."""
        return len(self.keys) > 2

    @property
    def windows(self) -> tuple[list[int], list[int]]:
        """The indices among the keys of those that its joints are of, the key passed in the middle.

        Of an end without a joint they say nothing.
        """
        return support_of(
            isinstance(self.start, InteriorKnot), isinstance(self.end, InteriorKnot), self.apart
        )

    @property
    def is_linear(self) -> bool:
        """Whether it goes straight from key to key, as quickly as the easing says."""
        return self.start == self.end == 1.0

    @property
    def end_speeds(self) -> tuple[float, float]:
        """How fast `weight` grows with the share at the first key and at the second one."""
        if (
            self.is_linear
            or isinstance(self.start, InteriorKnot)
            or isinstance(self.end, InteriorKnot)
        ):
            return 1.0, 1.0
        return self.start, self.end

    def weight(self, share: float) -> float:
        """Return which share of the way is done after a share of the interval's time."""
        if (
            self.is_linear
            or isinstance(self.start, InteriorKnot)
            or isinstance(self.end, InteriorKnot)
        ):
            return share
        # The cubic from 0 to 1 with these slopes at its ends.
        rest = 1.0 - share
        return share * (rest * rest * self.start + share * (rest * (3.0 - self.end) + share))


def pose_segments(clip: Clip) -> tuple[PoseSegment, ...]:
    """Return the transits of a clip's intervals, in their order."""
    return _pose_segments(clip.layer, clip.frames, clip.loop, clip.baseline)


@memoized_on
def _pose_segments(
    layer: Layer,
    frames: FrameRange,
    loop: bool,  # noqa: FBT001 - a field of the clip
    baseline: Baseline | None,
) -> tuple[PoseSegment, ...]:
    clip = Clip(layer=layer, frames=frames, loop=loop, fps=1.0, baseline=baseline)
    return tuple(
        _pose_segment(clip, number, *around)
        for number, around in enumerate(adjacent_segments(clip))
    )


def _pose_segment(
    clip: Clip, number: int, at_start: "AdjacentSegments", at_end: "AdjacentSegments"
) -> PoseSegment:
    """Return the transit of one of a clip's spans."""
    keys, found = clip.keys, clip_segments(clip)
    first, last, _, _ = found[number]
    start, end = (
        _tangent_of(clip, number, at_start, side=1),
        _tangent_of(clip, number, at_end, side=0),
    )
    window, turns, apart = [keys[first], keys[last]], [keys[first].revolutions], [False, False]
    others: list[tuple[Keyframe, int]] = []
    if (
        isinstance(start, InteriorKnot)
        and at_start.before is not None
        and at_start.after is not None
    ):
        before, after = keys[found[at_start.before].first], found[at_start.after]
        window.insert(0, before)
        turns.insert(0, before.revolutions)
        if at_start.after != number:
            apart[0] = True
            others.append((keys[after.last], keys[after.first].revolutions))
    if isinstance(end, InteriorKnot) and at_end.before is not None and at_end.after is not None:
        before, after = keys[found[at_end.before].first], found[at_end.after]
        window.append(keys[after.last])
        turns.append(keys[after.first].revolutions)
        if at_end.before != number:
            apart[1] = True
            others.append((before, before.revolutions))
    return PoseSegment(
        keys=(*window, *(key for key, _ in others)),
        revolutions=(*turns, *(turns for _, turns in others)),
        start=start,
        end=end,
        apart=(apart[0], apart[1]),
    )


class AdjacentSegments(NamedTuple):
    """By which spans, by their numbers, the motion reaches a key and leaves it, if it does."""

    before: int | None
    after: int | None


def adjacent_segments(clip: Clip) -> list[tuple[AdjacentSegments, AdjacentSegments]]:
    """Return by which spans the motion passes the two keys of each of a clip's spans.

    Keys of a cycle are passed as in every repeat, also by what leads to it and on from it.
    """
    found, rings, _ = segment_layout(clip)
    ways = {span.first: number for number, span in enumerate(found) if span.first != span.last}
    ends = {span.last: number for number, span in enumerate(found) if span.first != span.last}
    known = {
        index: AdjacentSegments(ends.get(index), ways.get(index)) for index in range(len(clip.keys))
    }
    last = len(clip.keys) - 1
    is_whole = clip.loop and clip.keys[last].frame - clip.keys[0].frame == clip.period
    if is_whole and have_same_map(clip.keys[0], clip.keys[last]):
        known[0] = known[last] = AdjacentSegments(ends.get(last), ways.get(0))
    for ring in rings:
        for place, (index, number) in enumerate(zip(ring.keys, ring.segments, strict=False)):
            known[index] = AdjacentSegments(ring.segments[place - 1], number)
    for ring in rings:
        _continue_from_cycle(clip, ring, known)
    held = {ring.keys[0] for ring in rings if not ring.segments}
    return [
        (
            AdjacentSegments(None, number) if span.first in held else known[span.first],
            AdjacentSegments(number, None) if span.last in held else known[span.last],
        )
        for number, span in enumerate(found)
    ]


def _continue_from_cycle(
    clip: Clip, ring: ResolvedCycle, known: dict[int, AdjacentSegments]
) -> None:
    """Let a key at the end of a cycle that has the pose shown there go on from the cycle."""
    keys, following = clip.keys, ring.keys.stop
    if ring.shows_end or following in ring.keys:
        return
    source = ring.cycle.source_frame(ring.end)
    shown = next((index for index in ring.keys if keys[index].frame == source), None)
    if shown is None or not ring.segments or not have_same_map(keys[shown], keys[following]):
        return
    if known[following].before is None:
        after = known[following].after
        is_through = keys[following].tangent_mode is TangentMode.SMOOTH
        known[following] = known[shown]._replace(after=known[shown].after if is_through else after)


def _tangent_of(clip: Clip, number: int, at: AdjacentSegments, *, side: int) -> KeyTangent:
    """Return how a span reaches its second key or, on side 1, leaves its first one."""
    keys, found = clip.keys, clip_segments(clip)
    span, index = found[number], found[number][1 - side]
    legs = [None if each is None else _tangent_segment_of(found[each]) for each in at]
    end = tangents_at(keys, index, legs[0], legs[1], have_same_map)[side]
    own, other = _tangent_segment_of(span), legs[side]
    if other is None or at[side] == number:
        return end
    # A key of a cycle: the velocity is that in it, the time to come to it or go on is the span's.
    pace, usual = (keys[leg.first].easing.end_speeds[1 - side] for leg in (own, other))
    if not isinstance(end, InteriorKnot) or usual == 0.0:
        return stop_factor(pace) if 0.0 in (end, usual) else 1.0
    if not 0.0 < pace < inf:
        return 1.0
    lengthened = pace * other.frames / own.frames
    return replace(end, start_pace=lengthened) if side else replace(end, end_pace=lengthened)


def _tangent_segment_of(span: Segment) -> TangentSegment:
    return TangentSegment(span.first, span.last, span.frames)


def have_same_map(key: Keyframe, other_key: Keyframe) -> bool:
    """Tell whether two keys' poses have the same map."""
    pose, other = key.pose, other_key.pose
    if pose is other or pose.phi is other.phi:
        return True
    pairs = ((pose.phi, other.phi), (pose.psi, other.psi), (pose.logs, other.logs))
    return all(np.abs(one - two).max(initial=0.0) <= SAME_MAP for one, two in pairs)
