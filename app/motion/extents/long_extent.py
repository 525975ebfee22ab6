"""How far the layers reach in more frames than are measured one by one.

Between two frames at which anything is keyed, layers move smoothly, or as often before in a cycle.
There some frames are measured. Where a box that bends, or moves fast, may stick out of all between
two of them, the one in the middle is measured, too, and so on. What is left when too many were
measured counts as far as it may reach, so that nothing is beyond what is found.
"""

from collections.abc import Callable, Iterator, Sequence
from heapq import heapify, heappop, heappush
from itertools import count, pairwise
from math import lcm
from typing import Final, NamedTuple

import numpy as np

from app.document import Document, FrameRange, Layer
from engine.arrays import Floats

MOST_MEASURED: Final = 1_000  # frames; up to so many are all measured
MOST_WITHIN: Final = 7  # rounds that are measured first between two keys
MOST_PHASES: Final = 240  # frames of a round that are measured, beside those that are keyed
MOST_AT_FIRST: Final = 60  # frames of these rounds
FEWEST_ROUNDS: Final = 4  # of which only some are measured
MOST_REPEATED: Final = (
    250  # frames that a cycle brings again and that are measured as keyed ones are
)
SETTLING: Final = 48  # frames that springs take to come to rest, or most of it
# Of the longer side: what is found may reach so much less than some frame. It is a fraction of the
# room that a fitted picture has around the motion.
TOLERANCE: Final = 0.002
# Of what a box changes between two frames: by how much it is taken to reach beyond both.
BEYOND: Final = 0.25
GOLDEN: Final = (5**0.5 - 1) / 2

# How far the layers reach in a frame: to the left, down, right and up, (f, 4).
Reaches = Floats
Measure = Callable[[int], Reaches]


class UnkeyedFrames(NamedTuple):
    """Frames between two at which something is keyed, both included, in rounds of so many."""

    first: int
    last: int
    period: int
    phases: Sequence[int]  # the frames of each round that are measured, from its first one on

    @property
    def period_count(self) -> int:
        """How many whole rounds there are."""
        return (self.last - self.first + 1) // self.period

    def frames_of_period(self, number: int) -> list[int]:
        """Return the frames of a round that are measured; after the last one, of what is left."""
        start = self.first + number * self.period
        return [start + phase for phase in self.phases if start + phase <= self.last]


class _Gap(NamedTuple):
    """Rounds between two that are measured, and how far they may reach, (4,)."""

    stretch: UnkeyedFrames
    ends: tuple[int, int]
    reaches: tuple[Floats, Floats]  # of both ends, each (p, f, 4)
    bound: Floats


def farthest_reach(document: Document, frames: FrameRange, measure: Measure) -> Floats:
    """Return how far the layers reach in any of these frames: left, down, right and up, (4,)."""
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
    """What is measured of the frames, and how far that reaches."""

    def __init__(self, measure: Measure) -> None:
        self._measure = measure
        self._farthest: Floats = np.full(4, -np.inf)
        self._measured = 0

    def begin(self, stretch: UnkeyedFrames, most: int) -> Iterator[_Gap]:
        """Measure the ends of a stretch and some rounds within; yield the gaps between these."""
        within = max(1, min(most, MOST_AT_FIRST // len(stretch.phases)))
        if rest := stretch.frames_of_period(stretch.period_count):
            self._reach(rest)
        # At uneven distances: what swings may be alike at even ones.
        last = stretch.period_count - 1
        shares = ((i + (i * GOLDEN) % 1 - 0.5) / (within + 1) for i in range(1, within + 1))
        numbers = sorted({0, last, *(round(last * share) for share in shares)})
        reaches = [self._reach(stretch.frames_of_period(number)) for number in numbers]
        for ends, both in zip(pairwise(numbers), pairwise(reaches), strict=True):
            yield from self._split(stretch, ends, both)

    def close(self, gaps: list[_Gap]) -> Floats:
        """Measure within the gaps that may reach farthest; return how far all reaches."""
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
        """Measure some frames; return how far the layers reach in each, (p, f, 4)."""
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
    """Return the stretches between the frames at which anything is keyed."""
    sprung = [each for each in document.layers if any(spring.enabled for spring in each.springs)]
    swinging = {each.id for each in sprung}
    # What carries springs sets them swinging, too.
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
    """Yield the frames at which a layer's motion is keyed, and those beside where it may jump.

    Springs that it sets swinging take `settling` frames after each of these.
    """
    moves = [*layer.key_frames, *(key.frame for key in layer.transform_keys)]
    jumps = [frame for cycle in layer.cycles for frame in (cycle.first, cycle.last)]
    jumps += [cycle.until for cycle in layer.cycles if cycle.until is not None]
    jumps += [frame for joint in layer.attachments for frame in (joint.frame, joint.kept_from)]
    for track in layer.tracks:
        times = [track.delay + key.frame for key in track.keys]
        moves += times
        jumps += (times[0], times[-1])
    if document.loop:
        # What is late goes on from the beginning.
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
    """Return after how many frames all that repeats between two frames is as before."""
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
