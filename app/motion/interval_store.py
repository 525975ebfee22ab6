"""All in-betweens of a figure on one mesh, by their content: what is there, and what is missing."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field
from functools import partial
from itertools import chain
from typing import Literal

from app.document import Clip, Moment, Pose, intervals, resting_pose, time_of, transits
from app.motion.inbetweens import PoseSampler
from app.motion.intervals import (
    Build,
    Found,
    Interval,
    OneFrame,
    Pair,
    Prepared,
    pair_of,
    prepare_frame,
    prepare_intervals,
)
from app.motion.paint_order import painted_triangles
from app.motion.posable_mesh import PosableMesh
from app.motion.vertices import Placed, Streamed, Vertices
from engine.arrays import Complexes
from engine.interpolation import Joint

BUDGET = 2**30  # bytes of one store
SPARE = 32  # the part of it that may be taken by what no present clip needs: a 32nd
EXPECTED = 100  # bytes a vertex that a series is thought to take before one is built
Part = Literal["frame", "in-betweens", "fine", "series"]  # of what is made of a clip


@dataclass(slots=True, kw_only=True, eq=False)
class IntervalStore:
    """The in-betweens of a figure on a mesh; of the main thread alone.

    They are known by their content (`Pair`), so that undo, a copied key or another method that is
    tried again find what was made for them before. Of an interval there is nothing, one frame, all
    of it prepared, or that as series. What workers need is handed to them frozen; what they find is
    taken in whenever it comes, also where nothing asks for it any more.

    What the clips that are present need stays, on the way to the budget's end without its series,
    the farthest from the playhead first. All else makes room before, what was wanted least lately
    first; that to which undo and redo lead, last.

    Parameters
    ----------
    mesh : PosableMesh
    budget : int
        In bytes.
    sampler : PoseSampler, optional
        Of the workers; None as long as nothing moves.
    whole : Clip, optional
        The newest one of the document all of whose in-betweens were there.
    build : Build, optional
        A series in the making, while no worker is at it.
    """

    mesh: PosableMesh
    budget: int = BUDGET
    sampler: PoseSampler | None = None
    whole: Clip | None = None
    build: Build | None = None
    _known: dict[Pair, Interval] = field(init=False, default_factory=dict)  # last wanted, last
    _sizes: dict[Pair, int] = field(init=False, default_factory=dict)
    _present: dict[Clip, tuple[Pair, ...]] = field(init=False, default_factory=dict)
    _nearby: dict[Clip, tuple[Pair, ...]] = field(init=False, default_factory=dict)
    _failures: frozenset[tuple[Part, tuple[Pair, ...]]] = field(init=False, default=frozenset())
    _frame: float = field(init=False, default=0)

    # What is there.

    def interval(self, clip: Clip, number: int) -> Interval | None:
        """Return what is known of one of a clip's intervals."""
        return self._known.get(pair_of(clip, number))

    def prepared(self, clip: Clip) -> tuple[Prepared, ...] | None:
        """Return the in-betweens of all of a clip's intervals; None where some are missing."""
        if clip.figure.domain is not self.mesh.source:
            return None
        known = [self._known.get(pair) for pair in self._of(clip)]
        every = [each.inbetweens for each in known if each is not None and each.inbetweens]
        return tuple(every) if len(every) == len(known) else None

    def has(self, clip: Clip) -> bool:
        """Tell whether all in-betweens of a clip are prepared."""
        return self.prepared(clip) is not None

    def has_failed(self, clip: Clip, part: Part = "in-betweens") -> bool:
        """Tell whether a part is known to be impossible for a clip."""
        return (part, self._of(clip)) in self._failures

    def is_exact(self, clip: Clip, frame: float) -> bool:
        """Tell whether what belongs to a frame is there, and nothing has to stand in for it."""
        if clip.figure.domain is not self.mesh.source:
            return False
        moment = time_of(clip, frame)
        if resting_pose(clip, moment) is not None:
            return True
        known = self.interval(clip, moment.interval)
        return known is not None and (
            known.inbetweens is not None
            or (known.series is not None and known.series.covers(moment.weight))
            or (known.one is not None and known.one.weight == moment.weight)
        )

    def vertices(self, clip: Clip, frame: float) -> Vertices | None:
        """Return where the vertices are at a frame; None where that `is_exact` says no."""
        if not self.is_exact(clip, frame):
            return None
        moment = time_of(clip, frame)
        resting = resting_pose(clip, moment)
        triangles = painted_triangles(self.mesh.domain.mesh, clip, frame)
        if resting is not None:
            return Placed(positions=self.mesh.posed(resting), triangles=triangles)
        known = self._known[pair_of(clip, moment.interval)]
        if known.series is not None and known.series.covers(moment.weight):
            return Streamed(known.series, known.distortions, moment.weight, triangles)
        if known.one is not None and known.one.weight == moment.weight:
            return Placed(positions=known.one.positions, triangles=triangles)
        if known.inbetweens is None:
            return None
        positions = known.inbetweens.frame(moment.weight).positions
        return Placed(positions=positions, triangles=triangles)

    def positions(self, clip: Clip, frame: float) -> Complexes | None:
        """Return the same, worked out."""
        vertices = self.vertices(clip, frame)
        return None if vertices is None else vertices.positions

    def nearest(self, clip: Clip, moment: Moment) -> Pose | OneFrame:
        """Return which known pose between two keys, theirs included, is nearest to a moment."""
        after = moment.weight > 0.5
        distance = 1.0 - moment.weight if after else moment.weight
        known = self.interval(clip, moment.interval)
        one = None if known is None else known.one
        if one is not None and abs(one.weight - moment.weight) <= distance:
            return one
        return clip.keys[intervals(clip)[moment.interval][after]].pose

    def kept(self, clip: Clip) -> Mapping[int, float]:
        """Return how much of its velocity the bounds leave to the motion at keys, by their frames.

        From 0, a stop, to 1; of those that it passes through, as far as that is known.
        """
        found: dict[int, float] = {}
        for number, transit in enumerate(transits(clip)):
            known = self.interval(clip, number)
            if known is None or known.inbetweens is None:
                continue
            first = int(isinstance(transit.start, Joint))
            ends, keys = (transit.start, transit.end), transit.keys[first : first + 2]
            for end, key, kept in zip(ends, keys, known.kept, strict=True):
                if isinstance(end, Joint):
                    found[key.frame] = kept
        return found

    @property
    def nbytes(self) -> int:
        """Bytes of all that is known."""
        return sum(self._sizes.values())

    def snapshot(self) -> "IntervalStore":
        """Return what a worker may read while this goes on."""
        copied = copy(self)
        copied._known = dict(self._known)  # noqa: SLF001 - its own
        return copied

    # What is missing, and what workers do about it.

    def missing(self, clip: Clip, frame: float) -> list[int]:
        """Return the numbers of intervals to prepare, the nearest first, and each pair once."""
        pairs, nearest = self._of(clip), dict[Pair, int]()
        for number in _by_nearness(clip, frame):
            nearest.setdefault(pairs[number], number)
        return [number for pair, number in nearest.items() if not self._is_prepared(pair)]

    def preparing(
        self, clip: Clip, wanted: Sequence[int], sibling: PoseSampler | None = None
    ) -> Callable[[], Found]:
        """Return what prepares some of a clip's intervals."""
        return partial(
            prepare_intervals,
            clip,
            wanted,
            self.mesh,
            self.sampler,
            sibling=sibling,
            keep=frozenset(self._poses()),
        )

    def making_frame(self, clip: Clip, frame: float) -> Callable[[], Found] | None:
        """Return what makes the in-between at a frame alone; None where it is there or cannot be.

        It cannot before the first in-betweens of a figure, which take longer.
        """
        figure, sampler = clip.figure, self.sampler
        if figure.domain is not self.mesh.source or self.is_exact(clip, frame):
            return None
        if sampler is None or sampler.anchor != figure.anchor or clip.baseline is not None:
            return None
        keep = frozenset(self._poses())
        return partial(prepare_frame, clip, frame, self.mesh, sampler, keep=keep)

    def has_room(self) -> bool:
        """Tell whether another interval fits into the budget beside those that are needed."""
        largest = max((each.nbytes - each.streamed for each in self._known.values()), default=0)
        return self._needed() + largest <= self.budget

    def next_build(self, clip: Clip, frame: float, *, heat: bool) -> Build | None:
        """Hand out the series that is in the making, or is wanted next; None where all is there.

        Parameters
        ----------
        clip : Clip
        frame : float
            The intervals nearest to it come first; those beyond the budget stay without.
        heat : bool
            Whether distortions are shown.
        """
        build, self.build = self.build, None
        if not self.has(clip):
            return None
        pairs = self._of(clip)
        if build is not None and build.pair in pairs:
            return build
        used = self._needed()
        for pair in dict.fromkeys(pairs[number] for number in _by_nearness(clip, frame)):
            known = self._known[pair]
            for distortions, series in enumerate((known.series, known.distortions)):
                if series is not None:
                    used += series.nbytes
                elif known.sites is not None and (heat or not distortions):
                    wanted = known.extents[distortions] or self._expected(distortions)
                    if used + wanted > self.budget:
                        return None
                    return Build(pair, known, distortions=bool(distortions))
        return None

    # What changes it.

    def pin(self, present: Sequence[Clip], nearby: Sequence[Clip], frame: float) -> None:
        """Take note of the clips that are needed now.

        Parameters
        ----------
        present : sequence of Clip
            The document's first.
        nearby : sequence of Clip
            Those to which undo and redo lead.
        frame : float
            Where the playhead is.
        """
        self._frame = frame
        clips = tuple(dict.fromkeys(present)), tuple(dict.fromkeys(nearby))
        if clips != (tuple(self._present), tuple(self._nearby)):
            for pair in self._pinned():
                if pair in self._known:
                    self._known[pair] = self._known.pop(pair)
            self._nearby = {clip: self._of(clip) for clip in nearby}
            self._present = {clip: self._of(clip) for clip in present}
            wanted = set(self._present.values())
            self._failures = frozenset(each for each in self._failures if each[1] in wanted)
            self._make_room()
        if self.whole != present[0] and self.has(present[0]):
            self.whole = present[0]

    def take(self, found: Found) -> None:
        """Take in what a worker has found, for whichever clip that was."""
        if found.sampler is not None and self._fits(found.sampler):
            self.sampler = found.sampler
        for pair, newer in found.intervals.items():
            older = self._known.pop(pair, None)
            self._set(pair, newer if older is None else older.joined(newer))
        self._make_room()

    def take_build(self, build: Build) -> None:
        """Take a series back, finished or not."""
        self.build = build if build.series is None else None
        self.take(build.found)

    def fail(self, part: Part, clip: Clip) -> None:
        """Take note that a part cannot be made for a clip: that is not tried again."""
        self._failures |= {(part, self._of(clip))}

    def _set(self, pair: Pair, interval: Interval) -> None:
        self._known[pair] = interval
        self._sizes[pair] = interval.nbytes

    def _drop(self, pair: Pair) -> None:
        del self._known[pair], self._sizes[pair]

    def _make_room(self) -> None:
        """Drop what is needed least, until the rest is within the budget."""
        present, pinned = set(chain(*self._present.values())), set(self._pinned())
        spare = [pair for pair in self._known if pair not in pinned]
        while spare and (
            self.nbytes > self.budget
            or sum(map(self._sizes.__getitem__, spare)) > self.budget // SPARE
        ):
            self._drop(spare.pop(0))
        nearby = [pair for pair in self._known if pair in pinned and pair not in present]
        while nearby and self.nbytes > self.budget:
            self._drop(nearby.pop(0))
        if self.nbytes <= self.budget:
            return
        for clip, pairs in reversed(self._present.items()):
            for number in reversed(_by_nearness(clip, self._frame)):
                if self.nbytes > self.budget and pairs[number] in self._known:
                    self._set(pairs[number], self._known[pairs[number]].without_series())

    def _needed(self) -> int:
        """Return the bytes of what the present clips need, without series."""
        pairs = set(chain(*self._present.values())) & self._known.keys()
        return sum(self._sizes[pair] - self._known[pair].streamed for pair in pairs)

    def _expected(self, kind: int) -> int:
        """Return the bytes that another series may take: as many as the largest one so far."""
        series = [(each.series, each.distortions)[kind] for each in self._known.values()]
        sizes = [each.nbytes for each in series if each is not None]
        return max(sizes, default=EXPECTED * len(self.mesh.domain.mesh.vertices))

    def _is_prepared(self, pair: Pair) -> bool:
        known = self._known.get(pair)
        return known is not None and known.inbetweens is not None

    def _fits(self, sampler: PoseSampler) -> bool:
        """Tell whether a sampler is of the present anchor."""
        anchors = [clip.figure.anchor for clip in self._present]
        return self.sampler is None or not anchors or anchors[0] == sampler.anchor

    def _of(self, clip: Clip) -> tuple[Pair, ...]:
        """Return by what a clip's intervals are known."""
        known = self._present.get(clip) or self._nearby.get(clip)
        if known is not None:
            return known
        return tuple(pair_of(clip, number) for number in range(len(intervals(clip))))

    def _pinned(self) -> Iterator[Pair]:
        return chain(*self._nearby.values(), *self._present.values())

    def _poses(self) -> Iterator[Pose]:
        """Yield the poses whose samples are of use."""
        for known in self._known.values():
            yield from known.poses
        for clip in (*self._present, *self._nearby):
            yield from (key.pose for key in clip.keys)


def _by_nearness(clip: Clip, frame: float) -> list[int]:
    """Return the numbers of a clip's intervals, that at the frame first."""
    current = time_of(clip, frame).interval
    return sorted(range(len(intervals(clip))), key=lambda i: (abs(i - current), i < current))
