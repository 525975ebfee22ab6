"""The segments between the keys of a clip, also within its cycles.

A cycle has each segment between its keys once, and one from its last key to its first. The number
of repeats does not matter. The segment before a cycle ends at the cycle's first key. The segment
after it begins at the key that the cycle shows at the end of its repeats.
"""

from bisect import bisect_left, bisect_right
from itertools import pairwise
from typing import NamedTuple

from app.document.channels.cycles import Cycle
from app.document.layer import Layer
from app.document.queries.clips import Clip
from app.document.queries.memo import memoized_on
from app.document.settings import FrameRange


class Segment(NamedTuple):
    """From one key to the next: key indices, first frame and length in frames."""

    first: int
    last: int
    start: int
    frames: int

    def share(self, frame: float) -> float:
        """Return the elapsed share of the segment at a frame."""
        return (frame - self.start) / self.frames


class ResolvedCycle(NamedTuple):
    """A cycle of a clip, with the indices of its keys and its segments."""

    cycle: Cycle
    keys: range
    end: int  # frame at which the repeats end
    shows_end: bool  # whether the cycle shows that frame; otherwise a key there does
    segments: tuple[
        int, ...
    ]  # segment number after the key at the same index of `keys`; empty for a single key

    def covers(self, frame: float) -> bool:
        """Return whether a frame is in the cycle or its repeats."""
        return self.cycle.first <= frame < self.end or (self.shows_end and frame == self.end)


class SegmentLayout(NamedTuple):
    """The segments of a clip in the order of their frames, its cycles, and the loop segment."""

    segments: tuple[Segment, ...]
    cycles: tuple[ResolvedCycle, ...]
    loop_segment: Segment | None  # from the last key to the first


def clip_segments(clip: Clip) -> tuple[Segment, ...]:
    """Return the segments of a clip; `SegmentTime.segment` is an index into them."""
    return segment_layout(clip).segments


def segment_keys(clip: Clip) -> tuple[tuple[int, int], ...]:
    """Return the key indices of each segment, in the order of `clip_segments`."""
    return tuple((span.first, span.last) for span in clip_segments(clip))


def loop_segment(clip: Clip) -> Segment | None:
    """Return the segment from the last key to the first in a loop, if any."""
    return segment_layout(clip).loop_segment


def segment_layout(clip: Clip) -> SegmentLayout:
    return _segment_layout(clip.layer, clip.frames, clip.loop)


@memoized_on
def _segment_layout(
    layer: Layer,
    frames: FrameRange,
    loop: bool,  # noqa: FBT001 - a field of the clip
) -> SegmentLayout:
    at = [key.frame for key in layer.keys]
    rings = [_resolved_cycle(cycle, at, frames) for cycle in layer.cycles]
    ring_of = {index: ring for ring in rings for index in ring.keys}
    found = [span for ring in rings for span in _cycle_segments(ring, at)]
    for first, last in pairwise(range(len(at))):
        ring = ring_of.get(first)
        if ring is None or ring is not ring_of.get(last):
            found += _segment_after(ring, at, first, last, at[last])
    closing: list[Segment] = []
    if loop:
        # If a cycle begins between two of its keys, no segment leads to it.
        ring, round_ = ring_of.get(0), frames.last - frames.first
        if ring is None or at[0] == ring.cycle.first:
            closing = _segment_after(ring_of.get(len(at) - 1), at, len(at) - 1, 0, at[0] + round_)
            found += closing
    led = {index for span in found for index in (span.first, span.last)}
    if len(at) > 1:
        found += [Segment(alone, alone, at[alone], 1) for alone in {*range(len(at))} - led]
    found.sort(key=lambda span: span.start)
    numbers = {span: number for number, span in enumerate(found)}
    return SegmentLayout(
        tuple(found),
        tuple(
            ring._replace(segments=tuple(numbers[span] for span in _cycle_segments(ring, at)))
            for ring in rings
            if ring.keys
        ),
        closing[0] if closing else None,
    )


def _resolved_cycle(cycle: Cycle, at: list[int], frames: FrameRange) -> ResolvedCycle:
    keys = range(bisect_left(at, cycle.first), bisect_left(at, cycle.last))
    end = max(cycle.last, frames.last if cycle.until is None else cycle.until)
    follows = keys.stop < len(at) and at[keys.stop] == end
    return ResolvedCycle(cycle=cycle, keys=keys, end=end, shows_end=not follows, segments=())


def _cycle_segments(ring: ResolvedCycle, at: list[int]) -> list[Segment]:
    """Return the segments of a cycle; none for a single key."""
    if len(ring.keys) < 2:
        return []
    first, last = ring.keys[0], ring.keys[-1]
    pairs = [Segment(i, j, at[i], at[j] - at[i]) for i, j in pairwise(ring.keys)]
    return [*pairs, Segment(last, first, at[last], at[first] + ring.cycle.period - at[last])]


def _segment_after(
    ring: ResolvedCycle | None, at: list[int], first: int, last: int, to: int
) -> list[Segment]:
    """Return the segment after a key, or after the key's cycle, if there is one.

    The segment ends at the key `last`, at the frame `to`.
    """
    start = at[first]
    if ring is not None:
        start, shown = ring.end, ring.cycle.source_frame(ring.end)
        if len(ring.keys) > 1:
            first = next((index for index in ring.keys if at[index] == shown), -1)
    # A loop with one key has no segment from that key to itself.
    is_whole = first == last and ring is None
    return [] if first < 0 or to <= start or is_whole else [Segment(first, last, start, to - start)]


def segment_at_frame(clip: Clip, frame: float) -> tuple[int, Segment, float]:
    """Return the number and the segment at a frame, and its elapsed share, 0 to 1.

    Outside all segments the share stays at the nearest end. In a loop, frames wrap around. The clip
    must have segments.
    """
    if clip.loop and clip.period and frame not in clip.frames:
        frame = clip.frames.first + (frame - clip.frames.first) % clip.period
    found, rings, closing = segment_layout(clip)
    ring = next((ring for ring in rings if ring.covers(frame)), None)
    if ring is None and rings and closing is None:
        first, last = rings[0], rings[-1]
        if first.keys[0] == 0 and frame < first.cycle.first:
            ring, frame = first, first.cycle.first
        elif last.keys[-1] == len(clip.keys) - 1 and frame > last.end:
            ring, frame = last, last.end
    if ring is not None and ring.segments:
        source = ring.cycle.source_frame(frame)
        place = bisect_right(ring.keys, source, key=lambda index: clip.keys[index].frame) - 1
        number = ring.segments[place]
        frame = source if place >= 0 else source + ring.cycle.period
    elif ring is not None:
        number = next(n for n, span in enumerate(found) if ring.keys[0] in span[:2])
        return number, found[number], float(found[number].first != ring.keys[0])
    else:
        if frame < found[0].start and closing is not None:
            frame += clip.period
        number = max(0, bisect_right(found, frame, key=lambda span: span.start) - 1)
    return number, found[number], min(max(found[number].share(frame), 0.0), 1.0)
