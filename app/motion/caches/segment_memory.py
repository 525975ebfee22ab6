"""The memory of cached in-betweens, and one budget of bytes for all layers."""

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field
from itertools import chain
from weakref import WeakSet

from app.document import Clip, segment_keys, segment_time_at
from app.motion.caches.inbetween_jobs import CachedSegment
from app.motion.inbetweens.segment_keys import SegmentKey, segment_key

BUDGET = 2**30  # bytes


class MemoryBudget:
    """The bytes that the segments of all layers may take together.

    Beyond `limit`, segments that no clip needs are dropped first, the least recently used first.
    Then follow segments for undo and redo. Then follow series, the farthest from the playhead
    first. Prepared in-betweens of present clips stay. Segments that no clip needs take at most
    `spare` bytes anyway, by default a 64th of the limit.
    """

    def __init__(self, limit: int = BUDGET, spare: int | None = None) -> None:
        self.limit = limit
        self.spare = limit // 64 if spare is None else spare
        self.memories: WeakSet[SegmentMemory] = WeakSet()

    @property
    def nbytes(self) -> int:
        """Bytes of all segments."""
        return sum(memory.nbytes for memory in self.memories)

    def make_room(self) -> None:
        """Drop the least needed segments until the rest fits."""
        memories = list(self.memories)
        spare = [memory.spare_keys() for memory in memories]
        unneeded = sum(memory.bytes_of(keys) for memory, keys in zip(memories, spare, strict=True))
        excess = max(unneeded - self.spare, self.nbytes - self.limit)
        for memory, keys in zip(memories, spare, strict=True):
            excess = memory.drop(keys, excess)
        excess = self.nbytes - self.limit
        for memory in memories:
            excess = memory.drop(memory.nearby_keys(), excess)
        for memory in memories:
            excess = memory.drop_series(excess)


@dataclass(slots=True, weakref_slot=True, kw_only=True, eq=False)
class SegmentMemory:
    """The cached segments of a layer on one mesh, known by their content."""

    budget: MemoryBudget
    # In the order of last use, with sizes in bytes, and the largest sizes so far.
    _known: dict[SegmentKey, CachedSegment] = field(init=False, default_factory=dict)
    _sizes: dict[SegmentKey, tuple[int, int, int]] = field(init=False, default_factory=dict)
    largest: list[int] = field(init=False, default_factory=lambda: [0, 0, 0])
    present: dict[Clip, tuple[SegmentKey, ...]] = field(init=False, default_factory=dict)
    _nearby: dict[Clip, tuple[SegmentKey, ...]] = field(init=False, default_factory=dict)
    _frame: float = field(init=False, default=0)

    def __post_init__(self) -> None:
        self.budget.memories.add(self)

    def join(self, budget: MemoryBudget) -> None:
        """Share another budget."""
        self.budget.memories.discard(self)
        self.budget = budget
        budget.memories.add(self)

    def find(self, key: SegmentKey) -> CachedSegment | None:
        return self._known.get(key)

    def items(self) -> list[tuple[SegmentKey, CachedSegment]]:
        return list(self._known.items())

    def sizes_of(self, key: SegmentKey) -> tuple[int, int, int]:
        return self._sizes[key]

    @property
    def nbytes(self) -> int:
        """Bytes of all cached segments."""
        return sum(map(sum, self._sizes.values()))

    @property
    def other_bytes(self) -> int:
        """Bytes of the segments of other memories with the same budget."""
        return self.budget.nbytes - self.nbytes

    @property
    def needed_bytes(self) -> int:
        """Bytes that the present clips need, without series."""
        return sum(self._sizes[key][0] for key in self._known.keys() & self._keys(self.present))

    def snapshot(self) -> "SegmentMemory":
        """Return a copy that a worker may read while this memory changes."""
        copied = copy(self)
        copied._known, copied._sizes = dict(self._known), dict(self._sizes)  # noqa: SLF001 - its own
        copied.join(MemoryBudget())
        return copied

    def add(self, key: SegmentKey, newer: CachedSegment) -> None:
        """Add a computed segment, or parts of it."""
        older = self._known.pop(key, None)
        self.put(key, newer if older is None else older.joined(newer))

    def put(self, key: SegmentKey, segment: CachedSegment) -> None:
        """Replace a segment."""
        self._known[key], self._sizes[key] = segment, segment.sizes
        self.largest = list(map(max, self.largest, segment.sizes))

    def need(self, present: Sequence[Clip], nearby: Sequence[Clip], frame: float) -> bool:
        """Set the playhead, the present clips, and the clips after undo and redo.

        Return whether the clips are others than before.
        """
        self._frame = frame
        if self.present.keys() == set(present) and self._nearby.keys() == set(nearby):
            return False
        pinned = self._keys(self.present, self._nearby)
        for key in [key for key in self._known if key in pinned]:
            self._known[key] = self._known.pop(key)
        self._nearby = {clip: self.keys_of(clip) for clip in nearby}
        self.present = {clip: self.keys_of(clip) for clip in present}
        self.budget.make_room()
        return True

    def keys_of(self, clip: Clip) -> tuple[SegmentKey, ...]:
        """Return the keys of a clip's segments."""
        known = self.present.get(clip) or self._nearby.get(clip)
        return known or tuple(
            segment_key(clip, number) for number in range(len(segment_keys(clip)))
        )

    def spare_keys(self) -> list[SegmentKey]:
        """Return the segments that no clip needs, the least recently used first.

        The newest is about to be used.
        """
        pinned = self._keys(self.present, self._nearby)
        return [key for key in list(self._known)[:-1] if key not in pinned]

    def nearby_keys(self) -> list[SegmentKey]:
        """Return the segments that only undo and redo need."""
        nearby = self._keys(self._nearby) - self._keys(self.present)
        return [key for key in self._known if key in nearby]

    def bytes_of(self, keys: Sequence[SegmentKey]) -> int:
        return sum(sum(self._sizes[key]) for key in keys)

    def drop(self, keys: Sequence[SegmentKey], excess: int) -> int:
        """Drop segments in turn while there is an excess of bytes; return the rest of it."""
        for key in keys:
            if excess <= 0:
                break
            excess -= sum(self._sizes.pop(key))
            del self._known[key]
        return excess

    def drop_series(self, excess: int) -> int:
        """Drop series of present clips while there is an excess; return the rest of it."""
        for clip, keys in reversed(self.present.items()):
            for number in reversed(by_nearness(clip, self._frame)):
                known = self._known.get(keys[number])
                if known is not None and excess > 0:
                    excess -= sum(self._sizes[keys[number]][1:])
                    self.put(keys[number], known._replace(series=None, distortions=None))
        return excess

    def _keys(self, *clips: Mapping[Clip, tuple[SegmentKey, ...]]) -> set[SegmentKey]:
        return set(chain(*(keys for each in clips for keys in each.values())))


def by_nearness(clip: Clip, frame: float) -> list[int]:
    """Return the segment numbers of a clip, nearest to the frame first."""
    current = segment_time_at(clip, frame).segment
    return sorted(range(len(segment_keys(clip))), key=lambda i: (abs(i - current), i < current))
