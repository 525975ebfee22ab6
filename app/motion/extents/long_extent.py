"""Extents of animations too long to measure every frame.

Between two frames with keys, layers move smoothly, or repeat a cycle. Some of these frames are
measured. A side that bends or moves fast may exceed its values at both ends of a gap. The middle
frame of such a gap is then measured, and so on. Gaps left at the budget count with their bound, so
the result contains all frames.
"""

from collections.abc import Callable, Iterator, Sequence
from heapq import heapify, heappop, heappush
from itertools import count, pairwise
from math import lcm
from typing import Final, NamedTuple

import numpy as np

from app.document import IK_TARGET, TRANSFORM, Document, FrameRange, Layer
from engine.arrays import Floats

MOST_MEASURED: Final = 1_000  # frames; shorter ranges are measured completely
MOST_WITHIN: Final = 7  # periods measured first between two keys
MOST_PHASES: Final = 240  # measured frames of a period, besides frames with keys
MOST_AT_FIRST: Final = 60  # frames of these first periods
FEWEST_ROUNDS: Final = 4  # for fewer periods, every frame counts as a period
MOST_REPEATED: Final = 250  # repeated key frames of a cycle that are measured as keys
SETTLING: Final = 48  # frames until springs come nearly to rest
# Fraction of the longer side by which the result may be too small. It is a fraction of the margin
# around a fitted picture.
TOLERANCE: Final = 0.002
# Assumed overshoot between two frames, as a fraction of the change between them.
BEYOND: Final = 0.25
GOLDEN: Final = (5**0.5 - 1) / 2

# Extents of the layers in a frame: left, down, right and up, (f, 4).
Reaches = Floats
Measure = Callable[[int], Reaches]


class UnkeyedFrames(NamedTuple):
    """Frames between two neighbouring frames with keys, both included, divided into periods."""

    first: int
    last: int
    period: int
    phases: Sequence[int]  # measured frames of each period, relative to its first

    @property
    def period_count(self) -> int:
        """Number of whole periods."""
        return (self.last - self.first + 1) // self.period

    def frames_of_period(self, number: int) -> list[int]:
        """Return the measured frames of a period; the last number is the remainder."""
        start = self.first + number * self.period
        return [start + phase for phase in self.phases if start + phase <= self.last]


class _Gap(NamedTuple):
    """Periods between two measured ones, and the bound of their extent, (4,)."""

    stretch: UnkeyedFrames
    ends: tuple[int, int]
    reaches: tuple[Floats, Floats]  # of both ends, each (p, f, 4)
    bound: Floats


def farthest_reach(document: Document, frames: FrameRange, measure: Measure) -> Floats:
    """Return the largest extents of the layers in these frames: left, down, right and up, (4,)."""
    if frames.last - frames.first < MOST_MEASURED:
        every = [measure(frame).max(axis=0) for frame in range(frames.first, frames.last + 1)]
        whole: Floats = np.max(every, axis=0)
        return whole
    search = _Search(measure)
    stretches = _stretches(document, frames)
    most = min(MOST_WITHIN, MOST_MEASURED // len(stretches))
    gaps = [gap for stretch in stretches for gap in search.begin(stretch, most)]
    return search.close(gaps)


class _Search:
    """The measured extents and the number of measurements."""

    def __init__(self, measure: Measure) -> None:
        self._measure = measure
        self._farthest: Floats = np.full(4, -np.inf)
        self._measured = 0

    def begin(self, stretch: UnkeyedFrames, most: int) -> Iterator[_Gap]:
        """Measure the ends of a range and some periods within; yield the gaps between them."""
        within = max(1, min(most, MOST_AT_FIRST // len(stretch.phases)))
        if rest := stretch.frames_of_period(stretch.period_count):
            self._reach(rest)
        # Uneven distances, since a swinging motion may repeat at even ones.
        last = stretch.period_count - 1
        shares = ((i + (i * GOLDEN) % 1 - 0.5) / (within + 1) for i in range(1, within + 1))
        numbers = sorted({0, last, *(round(last * share) for share in shares)})
        reaches = [self._reach(stretch.frames_of_period(number)) for number in numbers]
        for ends, both in zip(pairwise(numbers), pairwise(reaches), strict=True):
            yield from self._split(stretch, ends, both)

    def close(self, gaps: list[_Gap]) -> Floats:
        """Measure within the gaps with the largest bounds; return the bounds of all extents."""
        turns = count()
        left = [(-self._excess(gap), next(turns), gap) for gap in gaps]
        heapify(left)
        begun = self._measured
        bounds = [self._farthest]
        while left:
            _, _, gap = heappop(left)
            size = float((self._farthest[:2] + self._farthest[2:]).max())
            if self._excess(gap) <= TOLERANCE * size:
                continue
            if self._measured - begun >= MOST_MEASURED:
                bounds.append(gap.bound)
                continue
            for part in self._split(gap.stretch, gap.ends, gap.reaches):
                heappush(left, (-self._excess(part), next(turns), part))
        found: Floats = np.max([*bounds, self._farthest], axis=0)
        return found

    def _excess(self, gap: _Gap) -> float:
        return float(np.max(gap.bound - self._farthest))

    def _reach(self, frames: Sequence[int]) -> Floats:
        """Measure frames; return the extents of the layers in each, (p, f, 4)."""
        reaches = np.array([self._measure(frame) for frame in frames])
        self._farthest = np.maximum(self._farthest, reaches.max(axis=(0, 1)))
        self._measured += len(frames)
        return reaches

    def _split(
        self, stretch: UnkeyedFrames, ends: tuple[int, int], reaches: tuple[Floats, Floats]
    ) -> Iterator[_Gap]:
        """Measure the middle of a gap, and yield the gaps before and after it."""
        (low, high), (before, after) = ends, reaches
        if high - low < 2:
            return
        middle = (low + high) // 2
        at = self._reach(stretch.frames_of_period(middle))
        share = (middle - low) / (high - low)
        bent = np.abs(at - (before + share * (after - before)))
        moved = np.maximum(np.abs(at - before), np.abs(after - at))
        beyond = np.maximum(2.0 * bent, BEYOND * moved)
        for part, both in (((low, middle), (before, at)), ((middle, high), (at, after))):
            if part[1] - part[0] > 1:
                bound = (np.maximum(*both) + beyond).max(axis=(0, 1))
                yield _Gap(stretch, part, both, bound)


def _stretches(document: Document, frames: FrameRange) -> list[UnkeyedFrames]:
    """Return the ranges between frames with keys."""
    sprung = [each for each in document.layers if any(spring.enabled for spring in each.springs)]
    swinging = {each.id for each in sprung}
    # A moving ancestor sets springs swinging too.
    swinging |= {each.id for layer in sprung for each in document.all_ancestors(layer.id)}
    keyed = {
        frame
        for layer in document.layers
        for frame in _keyed(document, layer, SETTLING if layer.id in swinging else 0)
    }
    inside = {frame for frame in keyed if frame in frames}
    ends = sorted({frames.first, frames.last, *inside})
    found = []
    for first, last in pairwise(ends):
        period = _period(document, first, last)
        phases = set(range(0, period, -(-period // MOST_PHASES)))
        if period > MOST_PHASES:
            phases |= {(frame - first) % period for frame in keyed}
        found.append(UnkeyedFrames(first, last, period, sorted(phases)))
    return found


def _keyed(document: Document, layer: Layer, settling: int) -> Iterator[int]:
    """Yield the frames of a layer's keys, and the frames next to possible jumps.

    After each of them follow `settling` frames for springs that the layer sets swinging.
    """
    moves = [*layer.key_frames, *(key.frame for key in layer.keys_of(TRANSFORM))]
    moves += [key.frame for key in layer.keys_of(IK_TARGET)]
    jumps = [frame for cycle in layer.cycles for frame in (cycle.first, cycle.last)]
    jumps += [cycle.until for cycle in layer.cycles if cycle.until is not None]
    jumps += [frame for joint in layer.attachments for frame in (joint.frame, joint.kept_from)]
    for track in layer.tracks:
        times = [track.delay + key.frame for key in track.keys]
        moves += times
        jumps += (times[0], times[-1])
    if document.loop:
        # Delayed keys wrap around.
        first, length = document.frames.first, document.frames.last - document.frames.first
        moves += [first + (frame - first) % max(length, 1) for frame in moves]
    for cycle in layer.cycles:
        until = document.frames.last if cycle.until is None else cycle.until
        own = [frame for frame in moves if cycle.contains(frame)]
        rounds = range(cycle.period, until - cycle.first + 1, cycle.period)
        if len(own) * len(rounds) * (1 + settling) <= MOST_REPEATED:
            moves += [frame + later for frame in own for later in rounds]
    for frame in (*moves, *jumps):
        yield from range(frame, frame + settling + 1)
    for frame in jumps:
        yield from (frame - 1, frame + 1)


def _period(document: Document, first: int, last: int) -> int:
    """Return the common period of all cycles that repeat between two frames, or 1."""
    end = document.frames.last
    period = lcm(
        *(
            cycle.period
            for layer in document.layers
            for cycle in layer.cycles
            if cycle.last <= first and last <= (end if cycle.until is None else cycle.until)
        )
    )
    return period if FEWEST_ROUNDS * period <= last - first else 1
