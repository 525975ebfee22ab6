"""Tangents of a clip's motion at its pose keys."""

from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple

import numpy as np

from app.baseline import Baseline
from app.document.channels.tangent_mode import TangentMode
from app.document.keyframe import Keyframe
from app.document.layer import Layer
from app.document.queries.clips import Clip
from app.document.queries.key_segments import ResolvedCycle, Segment, clip_segments, segment_layout
from app.document.queries.memo import memoized_on
from app.document.queries.tangents import KeyTangent, TangentSegment, stop_factor, tangents_at
from app.document.settings import FrameRange
from engine.interpolation import InteriorKnot, support_of

# Pixels. Maps whose coefficients differ less are visually equal: the solver reproduces a pose only
# to this accuracy.
SAME_MAP = 0.01


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PoseSegment:
    """Motion of a clip from one key to the next."""

    # The two keys, with the key before if `start` is a knot and the key after if `end` is one. Then
    # the outer keys of knots that belong to a neighbouring cycle, in the order of
    # `engine.interpolation`.
    keys: tuple[Keyframe, ...]
    revolutions: tuple[int, ...]  # additional full turns from each key to the next
    start: KeyTangent
    end: KeyTangent
    # Whether the knots belong to a cycle that does not contain this segment. The outer key at the
    # first knot, and at the second, then differs from the segment's own keys.
    apart: tuple[bool, bool] = (False, False)

    @property
    def has_smooth_tangent(self) -> bool:
        """Whether the motion depends on more keys than the two."""
        return len(self.keys) > 2

    @property
    def windows(self) -> tuple[list[int], list[int]]:
        """Indices of the keys of the knots, with the knot's own key in the middle.

        The entry of an end without a knot has no meaning.
        """
        return support_of(
            isinstance(self.start, InteriorKnot), isinstance(self.end, InteriorKnot), self.apart
        )

    @property
    def is_linear(self) -> bool:
        """Whether the motion is a straight blend in eased time."""
        return self.start == self.end == 1.0

    @property
    def end_speeds(self) -> tuple[float, float]:
        """Slopes of `weight` over the share at the first key and at the second."""
        if (
            self.is_linear
            or isinstance(self.start, InteriorKnot)
            or isinstance(self.end, InteriorKnot)
        ):
            return 1.0, 1.0
        return self.start, self.end

    def weight(self, share: float) -> float:
        """Return the weight of the second key after a share of the segment's eased time."""
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
    """Numbers of the segments before and after a key, if any."""

    before: int | None
    after: int | None


def adjacent_segments(clip: Clip) -> list[tuple[AdjacentSegments, AdjacentSegments]]:
    """Return the adjacent segments of both keys of each segment.

    Keys of a cycle have the tangents of its repeats, also in the segments before and after the
    cycle.
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
    """Continue the cycle's motion through a key at its end that has the pose shown there."""
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
    """Return the tangent of a segment at its second key or, for side 1, at its first."""
    keys, found = clip.keys, clip_segments(clip)
    span, index = found[number], found[number][1 - side]
    legs = [None if each is None else _tangent_segment_of(found[each]) for each in at]
    end = tangents_at(keys, index, legs[0], legs[1], have_same_map)[side]
    own, other = _tangent_segment_of(span), legs[side]
    if other is None or at[side] == number:
        return end
    # At a key of a cycle the velocity is that of the cycle, but the segment has its own length.
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
    pose, other = key.pose, other_key.pose
    if pose is other or pose.phi is other.phi:
        return True
    pairs = ((pose.phi, other.phi), (pose.psi, other.psi), (pose.logs, other.logs))
    return all(np.abs(one - two).max(initial=0.0) <= SAME_MAP for one, two in pairs)
